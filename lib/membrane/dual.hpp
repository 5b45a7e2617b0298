#pragma once
// Dual numbers for forward differentiation along one direction, and vectors of any number type.

#include <array>
#include <cmath>

#include "base/register.hpp"

namespace tanktread::membrane {

/// Dual number: a value and its directional derivative `slope`. `Number` is double or a Register.
template <class Number>
struct Dual {
  Number value, slope;

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator+(const Dual& a, const Number& b) { return {a.value + b, a.slope}; }
  friend Dual operator+(const Number& a, const Dual& b) { return b + a; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator-(const Dual& a, const Number& b) { return {a.value - b, a.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.value * b.value, a.slope * b.value + a.value * b.slope}; }
  friend Dual operator*(double a, const Dual& b) { return {a * b.value, a * b.slope}; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const Number ratio = a.value / b.value;
    return {ratio, (a.slope - ratio * b.slope) / b.value};
  }
  friend Dual operator/(double a, const Dual& b) {
    const Number ratio = a / b.value;
    return {ratio, -ratio * b.slope / b.value};
  }
  friend Dual sqrt(const Dual& a) {
    const Number root = tanktread::sqrt(a.value);
    return {root, 0.5 * a.slope / root};
  }
  friend Dual exp(const Dual& a) {
    const Number e = std::exp(a.value);
    return {e, e * a.slope};
  }
  friend Dual log(const Dual& a) { return {std::log(a.value), a.slope / a.value}; }
};

/// Vector in space, of any number type.
template <class N>
using Vector = std::array<N, 3>;
template <class N>
N dot(const Vector<N>& a, const Vector<N>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class N>
Vector<N> cross(const Vector<N>& a, const Vector<N>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace tanktread::membrane
