#include "membrane/mass_solver.hpp"

namespace tanktread::membrane {
namespace {

constexpr double residual_of_mass = 1e-13;
constexpr int iterations_allowed = 60;  // conjugate-gradient iterations allowed; more would cost as much as a factorisation

Eigen::Array3d column_products(const Net& a, const Net& b) { return a.cwiseProduct(b).colwise().sum().transpose(); }

// Returns a/b per component; 0 if b = 0, because the residual of this component is already 0.
Eigen::Array3d ratio(const Eigen::Array3d& a, const Eigen::Array3d& b) { return (b == 0).select(0., a / b); }

}  // namespace

MassSolver::MassSolver(const DirectSolverOptions& options, const surface::Symmetry& symmetry)
    : reference_(options, symmetry), direct_(options, symmetry) {}

void MassSolver::factor(const Eigen::SparseMatrix<double>& m0) {
  reference_.factor(m0);
  diagonal_ = m0.diagonal();
}

Net MassSolver::solve(const Eigen::SparseMatrix<double>& s, const Net& d) {
  constexpr int all[] = {0, 1, 2};
  return solve(s, d, all);
}

Eigen::VectorXd MassSolver::solve_scalar(const Eigen::SparseMatrix<double>& s, const Eigen::VectorXd& d) {
  constexpr int first[] = {0};
  Net columns = Net::Zero(d.size(), 3);
  columns.col(0) = d;
  return solve(s, columns, first).col(0);
}

/// Returns S^-1 d with the matrix S = s. Solves only for the columns `components` of d; all other columns of d must be zero.
Net MassSolver::solve(const Eigen::SparseMatrix<double>& s, const Net& d, std::span<const int> components) {
  const Eigen::VectorXd scale = diagonal_.cwiseQuotient(s.diagonal()).cwiseSqrt();
  const auto precondition = [&](const Net& r) { return Net(scale.asDiagonal() * reference_.solve(scale.asDiagonal() * r, components)); };
  const Eigen::Array3d enough = residual_of_mass * residual_of_mass * column_products(d, d);
  Net f = precondition(d), r = d - s * f;
  Net direction = Net::Zero(d.rows(), 3);
  Eigen::Array3d before = Eigen::Array3d::Zero();
  for (iterations_ = 0; iterations_ < iterations_allowed; ++iterations_) {
    if ((column_products(r, r) <= enough).all()) return f;
    const Net z = precondition(r);
    const Eigen::Array3d now = column_products(r, z);
    direction = z + direction * ratio(now, before).matrix().asDiagonal();
    const Net image = s * direction;
    const auto step = ratio(now, column_products(direction, image)).matrix().eval();
    f += direction * step.asDiagonal();
    r -= image * step.asDiagonal();
    before = now;
  }
  iterations_ = 0;
  direct_.factor(s);
  return direct_.solve(d, components);
}

}  // namespace tanktread::membrane
