#include "quadrature/gauss.hpp"

#include <cassert>
#include <cmath>
#include <map>
#include <numbers>

namespace tanktread::quadrature {
namespace {

struct Legendre {
  double value, derivative;
};

Legendre legendre(int n, double x) {
  double before = 1, now = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * now - (k - 1) * before) / k;
    before = now;
    now = next;
  }
  return {now, n * (x * now - before) / (x * x - 1)};
}

/// Returns the i-th largest root of the Legendre polynomial P_n, i = 0 .. n-1.
double root(int n, int i) {
  double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
  for (int step = 0; step < 20; ++step) {
    const auto [value, derivative] = legendre(n, x);
    const double change = value / derivative;
    x -= change;
    if (std::abs(change) < 1e-16) break;
  }
  return x;
}

GaussRule made(int n) {
  GaussRule rule{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int i = 0; i < (n + 1) / 2; ++i) {
    const double x = 2 * i + 1 == n ? 0. : root(n, i);
    const double slope = legendre(n, x).derivative;
    const double weight = 1 / ((1 - x * x) * slope * slope);
    rule.nodes[i] = (1 - x) / 2;
    rule.nodes[n - 1 - i] = (1 + x) / 2;
    rule.weights[i] = rule.weights[n - 1 - i] = weight;
  }
  return rule;
}

template <class Rule, class Make>
const Rule& kept(int n, std::map<int, Rule>& rules, Make make) {
  assert(n >= 1);
  const auto [rule, fresh] = rules.try_emplace(n);
  if (fresh) rule->second = make(n);
  return rule->second;
}

}  // namespace

const GaussRule& gauss(int n) {
  static std::map<int, GaussRule> rules;
  return kept(n, rules, made);
}

TensorRule tensor(const GaussRule& in_s, const GaussRule& in_t) {
  const int n = in_s.size() * in_t.size();
  TensorRule rule{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int j = 0, q = 0; j < in_t.size(); ++j) {
    for (int i = 0; i < in_s.size(); ++i, ++q) {
      rule.s[q] = in_s.nodes[i];
      rule.t[q] = in_t.nodes[j];
      rule.weights[q] = in_s.weights[i] * in_t.weights[j];
    }
  }
  return rule;
}

const TensorRule& tensor_gauss(int n) {
  static std::map<int, TensorRule> rules;
  return kept(n, rules, [](int points) { return tensor(gauss(points), gauss(points)); });
}

}  // namespace tanktread::quadrature
