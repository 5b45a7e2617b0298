#include "stokes/kernels/cauchy_kernel.hpp"

#include <algorithm>
#include <cmath>

#include "base/kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

struct Complex {
  Register re, im;
};

Complex operator*(const Complex& a, const Complex& b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }

Complex operator/(const Complex& a, const Complex& b) {
  const Register inverse = 1 / (b.re * b.re + b.im * b.im);
  return {(a.re * b.re + a.im * b.im) * inverse, (a.im * b.re - a.re * b.im) * inverse};
}

/// Returns 1/(zeta_j - z), with zeta_j the position of node j. The result is NaN or infinite if z coincides with the node.
inline Complex inverse(const CauchyNodes& nodes, int j, const Complex& z) {
  const Register x = nodes.x[j] - z.re, y = nodes.y[j] - z.im, square = 1 / (x * x + y * y);
  return {x * square, -y * square};
}

struct Value {
  Complex f, slope;
};

Value value(const CauchyNodes& nodes, const Complex& z, bool with_slope) {
  Complex one{}, sum{};
  for (int j = 0; j < nodes.n; ++j) {
    const Complex r = inverse(nodes, j, z);
    const Register c_re = nodes.dx[j] * r.re - nodes.dy[j] * r.im, c_im = nodes.dx[j] * r.im + nodes.dy[j] * r.re;
    one.re += c_re, one.im += c_im;
    sum.re += nodes.f[j] * c_re - nodes.g[j] * c_im;
    sum.im += nodes.f[j] * c_im + nodes.g[j] * c_re;
  }
  const Complex f = sum / one;
  if (!with_slope) return {f, Complex{}};
  Complex slope{};
  for (int j = 0; j < nodes.n; ++j) {
    const Complex r = inverse(nodes, j, z);
    const Complex c = {nodes.dx[j] * r.re - nodes.dy[j] * r.im, nodes.dx[j] * r.im + nodes.dy[j] * r.re};
    const Complex term = Complex{nodes.f[j] - f.re, nodes.g[j] - f.im} * (c * r);
    slope.re += term.re, slope.im += term.im;
  }
  return {f, slope / one};
}

}  // namespace

void cauchy_sums(const CauchyNodes& nodes, double scale, int n, const double* x, const double* y, double* f, double* fx, double* fy) {
  for (int begin = 0; begin < n; begin += lanes) {
    const int count = std::min(lanes, n - begin);
    Complex z;
    for (int l = 0; l < lanes; ++l) {
      const int i = begin + std::min(l, count - 1);
      z.re[l] = x[i], z.im[l] = y[i];
    }
    Value v = value(nodes, z, fx != nullptr);
    bool node = false;
    for (int l = 0; l < lanes; ++l)
      if (std::isnan(v.f.re[l])) z.re[l] += 1e-14 * scale, node = true;
    if (node) v = value(nodes, z, fx != nullptr);
    for (int l = 0; l < count; ++l) {
      f[begin + l] = v.f.re[l];
      if (fx) fx[begin + l] = v.slope.re[l], fy[begin + l] = -v.slope.im[l];
    }
  }
}

}  // namespace INSTRUCTIONS

KERNEL(void, cauchy_sums,
       (const CauchyNodes& nodes, double scale, int n, const double* x, const double* y, double* f, double* fx, double* fy),
       (nodes, scale, n, x, y, f, fx, fy))

}  // namespace tanktread::stokes
