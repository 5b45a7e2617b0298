#include "quadrature/gauss.hpp"

#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
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

/// Returns make(n). Each rule is computed at its first use and kept in one of several lists. Several threads may call this function, because a
/// rule does not change after it has entered its list.
template <class Rule, Rule (*make)(int)>
const Rule& kept(int n) {
  assert(n >= 1);
  struct Entry {
    int n;
    Rule rule;
    const Entry* next;
  };
  static std::array<std::atomic<const Entry*>, 64> lists{};
  std::atomic<const Entry*>& list = lists[static_cast<std::size_t>(n) % lists.size()];
  const Entry* const first = list.load(std::memory_order_acquire);
  for (const Entry* entry = first; entry; entry = entry->next)
    if (entry->n == n) return entry->rule;
  auto* const fresh = new Entry{n, make(n), first};  // never deleted
  while (!list.compare_exchange_weak(fresh->next, fresh, std::memory_order_release)) continue;
  return fresh->rule;
}

TensorRule made_tensor(int n) { return tensor(gauss(n), gauss(n)); }

}  // namespace

const GaussRule& gauss(int n) { return kept<GaussRule, made>(n); }

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

const TensorRule& tensor_gauss(int n) { return kept<TensorRule, made_tensor>(n); }

}  // namespace tanktread::quadrature
