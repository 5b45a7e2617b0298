#include "system/solvers/secants.hpp"

#include <utility>

namespace tanktread::coupling {

namespace {

constexpr double regularisation = 1e-2;  // regularisation of the normal equations of (4.13); needed because the corrections d_i (scaled to norm 1)
                                         // may be nearly parallel

}  // namespace

Secants::Secants(std::vector<State> pairs) : pairs_(std::move(pairs)) { factor(); }

void Secants::add(const State& correction, const State& jacobian_error, int most) {
  const double size = correction.norm();
  if (most == 0 || size == 0 || !jacobian_error.allFinite()) return;
  pairs_.push_back(correction / size);
  pairs_.push_back(jacobian_error / size);
  while (pairs_.size() > 2 * static_cast<std::size_t>(most)) pairs_.erase(pairs_.begin(), pairs_.begin() + 2);
  factor();
}

void Secants::factor() {
  const auto n = static_cast<Eigen::Index>(pairs_.size() / 2);
  if (n == 0) return;
  Eigen::MatrixXd gram = regularisation * Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) gram(i, j) += dot(correction(i), correction(j));
  gram_.compute(gram);
}

State Secants::operator()(const State& w) const {
  Eigen::VectorXd c(static_cast<Eigen::Index>(pairs_.size() / 2));
  for (Eigen::Index i = 0; i < c.size(); ++i) c[i] = dot(correction(i), w);
  State sum(w.layout());
  if (c.size() == 0) return sum;
  c = gram_.solve(c).eval();
  for (Eigen::Index i = 0; i < c.size(); ++i) sum += c[i] * pairs_[static_cast<std::size_t>(2 * i + 1)];
  return sum;
}

}  // namespace tanktread::coupling
