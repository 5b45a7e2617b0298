#include <algorithm>
#include <cmath>
#include <numbers>

#include "stokes/flow/duct_flow.hpp"

namespace tanktread::stokes {
namespace {

using std::numbers::pi;

class EllipseProfile : public DuctProfile {
 public:
  explicit EllipseProfile(const surface::Vec2& a) : a_(a), top_(1 / (2 / (a[0] * a[0]) + 2 / (a[1] * a[1]))) {}

  void evaluate(int n, const double* x2, const double* x3, double* u, double* u2, double* u3) const override {
    const double p = top_ / (a_[0] * a_[0]), q = top_ / (a_[1] * a_[1]);
    for (int i = 0; i < n; ++i) u[i] = top_ - p * x2[i] * x2[i] - q * x3[i] * x3[i];
    if (!u2) return;
    for (int i = 0; i < n; ++i) u2[i] = -2 * p * x2[i], u3[i] = -2 * q * x3[i];
  }

  double flow_rate() const override { return top_ * pi * a_[0] * a_[1] / 2; }

 private:
  surface::Vec2 a_;
  double top_;
};

/// Velocity profile of a rectangle with half sides A along y and B along z, where k_n = (2n + 1) pi/(2 B):
///   u = (B^2 - z^2)/2 - sum_n (-1)^n 2/(B k_n^3) cos(k_n z) cosh(k_n y)/cosh(k_n A)
/// The terms decay like exp(-k_n (A - |y|)). The axis with the larger (A - |y|)/B is chosen as y.
class RectangleProfile : public DuctProfile {
 public:
  explicit RectangleProfile(const surface::Vec2& sides) : half_(sides / 2) {}

  void evaluate(int n, const double* x2, const double* x3, double* u, double* u2, double* u3) const override {
    for (int i = 0; i < n; ++i) {
      const double d2 = half_[0] - std::abs(x2[i]), d3 = half_[1] - std::abs(x3[i]);
      const bool along2 = d2 * half_[0] > d3 * half_[1];
      const auto s = along2 ? series(half_[0], half_[1], x2[i], x3[i]) : series(half_[1], half_[0], x3[i], x2[i]);
      u[i] = s[0];
      if (u2) u2[i] = s[along2 ? 1 : 2], u3[i] = s[along2 ? 2 : 1];
    }
  }

  double flow_rate() const override {
    const double h = 2 * half_.minCoeff(), w = 2 * half_.maxCoeff();
    double sum = 0;
    for (int m = 999; m > 0; m -= 2) sum += std::tanh(m * pi * w / (2 * h)) / std::pow(m, 5);
    return w * h * h * h / 12 * (1 - 192 * h / (std::pow(pi, 5) * w) * sum);
  }

 private:
  static constexpr int most_terms = 20000;  // limit on the number of terms; reached only within 1e-3 half sides of a corner

  /// Returns u, du/dy and du/dz at (y, z) for the half sides a = A and b = B. Powers are computed by recurrence.
  static std::array<double, 3> series(double a, double b, double y, double z) {
    const double k = pi / (2 * b), near = std::max(0.0, a - std::abs(y)), far = a + std::abs(y), step = 2 * k;
    const int terms = static_cast<int>(std::min<double>(most_terms, 2 + 38 / std::max(step * near, 1e-6)));
    double c = std::cos(k * z), s = std::sin(k * z), e1 = std::exp(-k * near), e2 = std::exp(-k * far), e3 = std::exp(-2 * k * a);
    const double rc = std::cos(step * z), rs = std::sin(step * z), r1 = std::exp(-step * near), r2 = std::exp(-step * far),
                 r3 = std::exp(-2 * step * a);
    double u = 0, uy = 0, uz = 0, sign = 1;
    for (int n = 0; n < terms; ++n, sign = -sign) {
      const double kn = (2 * n + 1) * k, weight = sign * 2 / (b * kn * kn * kn * (1 + e3));
      u += weight * c * (e1 + e2);
      uy += weight * kn * c * (e1 - e2);
      uz -= weight * kn * s * (e1 + e2);
      const double turned = c * rc - s * rs;
      s = s * rc + c * rs, c = turned, e1 *= r1, e2 *= r2, e3 *= r3;
    }
    return {(b * b - z * z) / 2 - u, y < 0 ? uy : -uy, -z - uz};
  }

  surface::Vec2 half_;
};

}  // namespace

std::unique_ptr<DuctProfile> ellipse_profile(const surface::Vec2& semi_axes) { return std::make_unique<EllipseProfile>(semi_axes); }
std::unique_ptr<DuctProfile> rectangle_profile(const surface::Vec2& sides) { return std::make_unique<RectangleProfile>(sides); }

}  // namespace tanktread::stokes
