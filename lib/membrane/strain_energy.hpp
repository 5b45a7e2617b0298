#pragma once
// Strain energy given by the user as an expression in the two strain invariants. It is differentiated exactly: every operation acts on Taylor
// polynomials of second degree.

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/register.hpp"

namespace tanktread::membrane {

/// Value of a function of I1 and I2 with its first and second derivatives. `Number` is double, a register or a dual number.
template <class Number>
struct Taylor {
  Number value, by1, by2, by11, by12, by22;

  friend Taylor operator+(const Taylor& a, const Taylor& b) {
    return {a.value + b.value, a.by1 + b.by1, a.by2 + b.by2, a.by11 + b.by11, a.by12 + b.by12, a.by22 + b.by22};
  }
  friend Taylor operator*(double c, const Taylor& a) { return {c * a.value, c * a.by1, c * a.by2, c * a.by11, c * a.by12, c * a.by22}; }
  friend Taylor operator*(const Taylor& a, const Taylor& b) {
    return {a.value * b.value,
            a.value * b.by1 + a.by1 * b.value,
            a.value * b.by2 + a.by2 * b.value,
            a.value * b.by11 + 2.0 * (a.by1 * b.by1) + a.by11 * b.value,
            a.value * b.by12 + a.by1 * b.by2 + a.by2 * b.by1 + a.by12 * b.value,
            a.value * b.by22 + 2.0 * (a.by2 * b.by2) + a.by22 * b.value};
  }
  /// Returns the value and derivatives of the composition f(a), from f and its first two derivatives at a.
  static Taylor composed(const Number& f, const Number& slope, const Number& bend, const Taylor& a) {
    return {f,
            slope * a.by1,
            slope * a.by2,
            slope * a.by11 + bend * a.by1 * a.by1,
            slope * a.by12 + bend * a.by1 * a.by2,
            slope * a.by22 + bend * a.by2 * a.by2};
  }
};

/// Strain energy Psi(I1, I2) from a text with numbers, named constants, I1, I2, J = sqrt(I2 + 1), + - * / ^, exp, log, sqrt and parentheses.
/// Exponents must be constants. The constructor throws UserError if the text is not the energy of a membrane. The message starts with `what`, the
/// name of the deck key with the text.
class StrainEnergy {
 public:
  StrainEnergy(const std::string& what, const std::string& text, const std::map<std::string, double>& constants);

  /// Returns Psi with its derivatives, shifted by a constant so that Psi is 0 on an unstretched membrane.
  template <class Number>
  Taylor<Number> at(const Number& i1, const Number& i2) const {
    std::array<Taylor<Number>, most_operations> results;
    const Number zero = 0.0 * i1, one = zero + 1.0;
    results[0] = {i1, one, zero, zero, zero, zero};
    results[1] = {i2, zero, one, zero, zero, zero};
    std::size_t next = 2;
    for (const Operation& o : operations_) results[next++] = result(o, results[o.first], results[o.second]);
    Taylor<Number>& psi = results[next - 1];
    psi.value = psi.value - at_rest_;
    return psi;
  }

  double shear_modulus() const { return shear_modulus_; }  ///< shear modulus at small strains, in the unit of the user's energy expression
  double area_modulus() const { return area_modulus_; }    ///< area modulus at small strains, in the unit of the user's energy expression

 private:
  friend class ExpressionParser;
  enum class Kind { sum, product, shifted, scaled, power, root, exponential, logarithm };
  /// One operation of the energy expression. Its arguments are two earlier results, with the indices `first` and `second`, and a constant. Results 0
  /// and 1 are I1 and I2; result k + 2 is computed by operation k.
  struct Operation {
    Kind kind;
    std::size_t first, second;
    double constant;
  };
  static constexpr std::size_t most_operations = 96;

  template <class Number>
  static Taylor<Number> result(const Operation& o, const Taylor<Number>& a, const Taylor<Number>& b) {
    using std::exp, std::log, tanktread::sqrt;
    switch (o.kind) {
      case Kind::sum: return a + b;
      case Kind::product: return a * b;
      case Kind::shifted: return {a.value + o.constant, a.by1, a.by2, a.by11, a.by12, a.by22};
      case Kind::scaled: return o.constant * a;
      case Kind::power: {
        const Number bend = power(a.value, o.constant - 2), slope = bend * a.value;
        return Taylor<Number>::composed(slope * a.value, o.constant * slope, (o.constant * (o.constant - 1)) * bend, a);
      }
      case Kind::root: {
        const Number root = sqrt(a.value), slope = 0.5 / root;
        return Taylor<Number>::composed(root, slope, -0.5 * slope / a.value, a);
      }
      case Kind::exponential: {
        const Number e = by_lane(a.value, [](const auto& x) { return exp(x); });
        return Taylor<Number>::composed(e, e, e, a);
      }
      case Kind::logarithm: break;
    }
    const Number slope = 1.0 / a.value;
    return Taylor<Number>::composed(by_lane(a.value, [](const auto& x) { return log(x); }), slope, -slope * slope, a);
  }

  /// Applies a function to each lane of a register, or to a single number.
  template <class Number, class Function>
  static Number by_lane(const Number& a, const Function& f) {
    if constexpr (std::is_same_v<Number, Register>) {
      Register result;
      for (int l = 0; l < lanes; ++l) result[l] = f(a[l]);
      return result;
    } else {
      return f(a);
    }
  }

  /// Returns a^p. Whole powers up to 32 are computed by products.
  template <class Number>
  static Number power(const Number& a, double p) {
    constexpr double most_products = 32;
    if (p != std::floor(p) || std::abs(p) > most_products) {
      using std::exp, std::log;
      return by_lane(a, [p](const auto& x) { return exp(p * log(x)); });
    }
    const Number base = p < 0 ? 1.0 / a : a;
    Number product = 0.0 * a + 1.0;
    for (int k = 0; k < std::abs(p); ++k) product = product * base;
    return product;
  }

  void check(const std::string& what) const;

  std::vector<Operation> operations_;
  double at_rest_ = 0, shear_modulus_ = 0, area_modulus_ = 0;
};

}  // namespace tanktread::membrane
