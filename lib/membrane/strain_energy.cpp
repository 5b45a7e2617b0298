#include "membrane/strain_energy.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/words.hpp"
#include "membrane/laws.hpp"

namespace tanktread::membrane {

/// Recursive-descent parser that turns an expression into operations, with one member function per level of precedence.
class ExpressionParser {
 public:
  ExpressionParser(const std::string& what, const std::string& text, const std::map<std::string, double>& constants, StrainEnergy& energy)
      : what_(what), text_(text), constants_(constants), energy_(energy) {}

  void parse() {
    constexpr std::size_t longest = 2000;  // largest number of characters, because deep recursion on a longer text might exceed the stack
    if (text_.size() > longest)
      throw UserError(what_ + formatted(" is too long: it has %zu characters, more than %zu.", text_.size(), longest));
    const Term all = sum();
    if (here() != '\0') refuse("an operator or the end is expected");
    if (!all.slot) throw UserError(what_ + " must depend on I1 or I2, but is constant.");
    if (*all.slot + 1 != n_results()) emit(Kind::scaled, all, all, 1);  // appends a copy of the energy, because the energy must be the last result
    for (const auto& [name, value] : constants_)
      if (std::ranges::find(used_, name) == used_.end()) throw UserError(what_ + " does not use the constant `" + name + "`.");
  }

 private:
  using Kind = StrainEnergy::Kind;
  /// Value of a subexpression: the result with the index `slot` (see StrainEnergy::Operation), or the constant `number` if `slot` is not set.
  struct Term {
    double number = 0;
    std::optional<std::size_t> slot = {};
  };

  [[noreturn]] void refuse(const std::string& reason) const {
    const std::string place = next_ < text_.size() ? formatted(" at character %d", static_cast<int>(next_) + 1) : " at the end";
    throw UserError(what_ + " is not an expression: " + reason + place + " of `" + deck::shortened(text_, 80) + "`.");
  }

  char here() {
    while (next_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[next_]))) ++next_;
    return next_ < text_.size() ? text_[next_] : '\0';
  }
  bool take(char sign) { return here() == sign && ++next_; }

  std::size_t n_results() const { return energy_.operations_.size() + 2; }

  Term emit(Kind kind, const Term& a, const Term& b, double constant) {
    if (n_results() == StrainEnergy::most_operations)
      throw UserError(what_ + formatted(" is too long: it has more than %d operations.", static_cast<int>(StrainEnergy::most_operations) - 2));
    energy_.operations_.push_back({kind, *a.slot, b.slot.value_or(*a.slot), constant});
    return {0, n_results() - 1};
  }
  Term added(const Term& a, const Term& b) {
    if (a.slot && b.slot) return emit(Kind::sum, a, b, 0);
    if (a.slot || b.slot) return emit(Kind::shifted, a.slot ? a : b, {}, a.slot ? b.number : a.number);
    return {a.number + b.number};
  }
  Term multiplied(const Term& a, const Term& b) {
    if (a.slot && b.slot) return emit(Kind::product, a, b, 0);
    if (a.slot || b.slot) return emit(Kind::scaled, a.slot ? a : b, {}, a.slot ? b.number : a.number);
    return {a.number * b.number};
  }
  Term raised(const Term& a, const Term& exponent) {
    if (exponent.slot) refuse("an exponent must not depend on I1 and I2,");
    const double p = exponent.number;
    if (!a.slot) return {std::pow(a.number, p)};
    if (p == 0) return {1};
    return p == 1 ? a : p == 0.5 ? emit(Kind::root, a, {}, 0) : emit(Kind::power, a, {}, p);
  }

  Term sum() {
    Term total = product();
    while (here() == '+' || here() == '-') {
      const bool minus = text_[next_++] == '-';
      const Term next = product();
      total = added(total, minus ? multiplied({-1}, next) : next);
    }
    return total;
  }
  Term product() {
    Term total = signed_power();
    while (here() == '*' || here() == '/') {
      const bool over = text_[next_++] == '/';
      const Term next = signed_power();
      if (over && !next.slot && next.number == 0) refuse("a division by zero ends");
      total = multiplied(total, over ? raised(next, {-1}) : next);
    }
    return total;
  }
  Term signed_power() {
    if (take('-')) return multiplied({-1}, signed_power());
    if (take('+')) return signed_power();
    const Term base = operand();
    return take('^') ? raised(base, signed_power()) : base;
  }
  Term operand() {
    const char first = here();
    if (first == '(') return in_parentheses();
    if (std::isdigit(static_cast<unsigned char>(first)) || first == '.') return {number()};
    if (std::isalpha(static_cast<unsigned char>(first))) return named();
    refuse("a number, a name or `(` is expected");
  }
  Term in_parentheses() {
    constexpr int deepest = 100;
    if (!take('(')) refuse("`(` is expected");
    if (++depth_ > deepest) refuse(formatted("more than %d parentheses are open", deepest));
    const Term inner = sum();
    if (!take(')')) refuse("`)` is expected");
    --depth_;
    return inner;
  }
  double number() {
    double value = 0;
    const char* const first = text_.data() + next_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error != std::errc()) refuse("a number is expected");
    next_ += static_cast<std::size_t>(end - first);
    return value;
  }
  Term named() {
    const std::size_t first = next_;
    while (next_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[next_])) || text_[next_] == '_')) ++next_;
    const std::string name = text_.substr(first, next_ - first);
    if (name == "I1") return {0, 0};
    if (name == "I2") return {0, 1};
    if (name == "J") return area_ratio_ = area_ratio_.slot ? area_ratio_ : raised(added({0, 1}, {1}), {0.5});
    if (const auto constant = constants_.find(name); constant != constants_.end()) {
      used_.push_back(name);
      return {constant->second};
    }
    if (name == "sqrt") return raised(in_parentheses(), {0.5});
    if (name == "exp" || name == "log") {
      const Term a = in_parentheses();
      if (a.slot) return emit(name == "exp" ? Kind::exponential : Kind::logarithm, a, {}, 0);
      return {name == "exp" ? std::exp(a.number) : std::log(a.number)};
    }
    throw UserError(what_ + " contains the name `" + name + "`, which is not I1, I2, J, exp, log, sqrt or one of Membrane/constants.");
  }

  const std::string& what_;
  const std::string& text_;
  const std::map<std::string, double>& constants_;
  StrainEnergy& energy_;
  std::vector<std::string> used_;
  Term area_ratio_;
  std::size_t next_ = 0;
  int depth_ = 0;
};

StrainEnergy::StrainEnergy(const std::string& what, const std::string& text, const std::map<std::string, double>& constants) {
  for (const auto& [name, value] : constants) {
    const auto good = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    if (name.empty() || !std::isalpha(static_cast<unsigned char>(name.front())) || !std::ranges::all_of(name, good))
      throw UserError("Membrane/constants/" + name + " must be a name of letters, digits and _ that starts with a letter.");
    for (const char* taken : {"I1", "I2", "J", "exp", "log", "sqrt"})
      if (name == taken) throw UserError("Membrane/constants/" + name + " must have another name: `" + name + "` has a meaning in Membrane/energy.");
  }
  ExpressionParser(what, text, constants, *this).parse();
  const Taylor<double> rest = at(0.0, 0.0);
  at_rest_ = rest.value;
  shear_modulus_ = rest.by1 - rest.by2;
  area_modulus_ = 2 * rest.by2 + 4 * (rest.by11 + 2 * rest.by12 + rest.by22);
  check(what);
}

/// Throws UserError if the expression is not a possible energy of a membrane: the energy must be finite at small strains, and the unstretched
/// membrane must be stress-free and stable.
void StrainEnergy::check(const std::string& what) const {
  for (const double one : {1.0, 0.95, 1.05})
    for (const double other : {1.0, 0.95, 1.05}) {
      const Taylor<double> psi = at(one * one + other * other - 2, one * one * other * other - 1);
      const bool finite = std::isfinite(psi.value + psi.by1 + psi.by2 + psi.by11 + psi.by12 + psi.by22);
      if (!finite) throw UserError(what + formatted(" is not finite, or has no finite derivatives, where the stretches are %g and %g.", one, other));
    }
  const Taylor<double> rest = at(0.0, 0.0);
  const double tension = 2 * (rest.by1 + rest.by2), size = std::abs(rest.by1) + std::abs(rest.by2) + std::abs(area_modulus_);
  if (!(std::abs(tension) <= 1e-12 * size))
    throw UserError(what + formatted(" must have no tension on the unstressed surface, but 2 (dPsi/dI1 + dPsi/dI2) is %g there.", tension));
  if (!(shear_modulus_ > 0 && area_modulus_ > 0))
    throw UserError(what +
                    formatted(" must have positive moduli for small strains, but the shear modulus is %g and the area modulus is %g.",
                              shear_modulus_, area_modulus_));
}

}  // namespace tanktread::membrane
