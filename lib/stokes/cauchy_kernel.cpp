#include "stokes/cauchy_kernel.hpp"

#include <algorithm>

#include "stokes/pack.hpp"

namespace tanktread::stokes {
namespace {

struct Complex {
  Pack re, im;
};

Complex operator*(const Complex& a, const Complex& b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }

Complex operator/(const Complex& a, const Complex& b) {
  const Pack inverse = 1 / (b.re * b.re + b.im * b.im);
  return {(a.re * b.re + a.im * b.im) * inverse, (a.im * b.re - a.re * b.im) * inverse};
}

/// zeta_j - z, never quite zero.
Complex difference(const CauchyNodes& nodes, int j, const Complex& z, double tiny) {
  Complex d{nodes.x[j] - z.re, nodes.y[j] - z.im};
  d.re = d.re * d.re + d.im * d.im < tiny * tiny ? d.re + tiny : d.re;
  return d;
}

struct Value {
  Complex f, slope;
};

Value value(const CauchyNodes& nodes, const Complex& z, double tiny, bool with_slope) {
  Complex one{}, sum{};
  for (int j = 0; j < nodes.n; ++j) {
    const Complex c = Complex{nodes.dx[j] + Pack{}, nodes.dy[j] + Pack{}} / difference(nodes, j, z, tiny);
    one.re += c.re, one.im += c.im;
    sum.re += nodes.f[j] * c.re - nodes.g[j] * c.im;
    sum.im += nodes.f[j] * c.im + nodes.g[j] * c.re;
  }
  const Complex f = sum / one;
  if (!with_slope) return {f, Complex{}};
  Complex slope{};
  for (int j = 0; j < nodes.n; ++j) {
    const Complex d = difference(nodes, j, z, tiny);
    const Complex c = Complex{nodes.dx[j] + Pack{}, nodes.dy[j] + Pack{}} / d;
    const Complex term = Complex{nodes.f[j] - f.re, nodes.g[j] - f.im} * (c / d);
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
    const Value v = value(nodes, z, 1e-15 * scale, fx != nullptr);
    for (int l = 0; l < count; ++l) {
      f[begin + l] = v.f.re[l];
      if (fx) fx[begin + l] = v.slope.re[l], fy[begin + l] = -v.slope.im[l];
    }
  }
}

}  // namespace tanktread::stokes
