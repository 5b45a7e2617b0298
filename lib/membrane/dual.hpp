#pragma once
// Numbers that carry their derivative along one direction, and vectors of any kind of number.

#include <array>

#include "base/register.hpp"

namespace tanktread::membrane {

/// A value and its slope; `Number` is double or a Register.
template <class Number>
struct Dual {
  Number value, slope;
};

template <class N>
Dual<N> operator+(const Dual<N>& a, const Dual<N>& b) {
  return {a.value + b.value, a.slope + b.slope};
}
template <class N>
Dual<N> operator-(const Dual<N>& a, const Dual<N>& b) {
  return {a.value - b.value, a.slope - b.slope};
}
template <class N>
Dual<N> operator*(const Dual<N>& a, const Dual<N>& b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}
template <class N>
Dual<N> operator/(const Dual<N>& a, const Dual<N>& b) {
  const N ratio = a.value / b.value;
  return {ratio, (a.slope - ratio * b.slope) / b.value};
}
template <class N>
Dual<N> operator-(const Dual<N>& a) {
  return {-a.value, -a.slope};
}
template <class N>
Dual<N> operator+(const Dual<N>& a, double b) {
  return {a.value + b, a.slope};
}
template <class N>
Dual<N> operator+(double a, const Dual<N>& b) {
  return b + a;
}
template <class N>
Dual<N> operator-(const Dual<N>& a, double b) {
  return {a.value - b, a.slope};
}
inline Dual<Register> operator-(const Dual<Register>& a, const Register& b) { return {a.value - b, a.slope}; }
template <class N>
Dual<N> operator*(double a, const Dual<N>& b) {
  return {a * b.value, a * b.slope};
}
template <class N>
Dual<N> operator/(double a, const Dual<N>& b) {
  const N ratio = a / b.value;
  return {ratio, -ratio * b.slope / b.value};
}
using tanktread::sqrt;
template <class N>
Dual<N> sqrt(const Dual<N>& a) {
  const N root = sqrt(a.value);
  return {root, 0.5 * a.slope / root};
}

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
