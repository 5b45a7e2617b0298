#include "membrane/incomplete_solver.hpp"

#include <Eigen/IterativeLinearSolvers>

namespace tanktread::membrane {

namespace {

// Measured with the mass matrices of spheres of 3,458 and 13,826 control points: entries below 1e-2 of a row dropped take 7 iterations, below 1e-4
// 3, in a shorter time; more than twice as many entries as the matrix has gain nothing.
constexpr double dropped = 1e-4;
constexpr int fill = 2;

}  // namespace

struct IncompleteSolver::Impl {
  Eigen::BiCGSTAB<Eigen::SparseMatrix<double, Eigen::RowMajor>, Eigen::IncompleteLUT<double>> solver;
};

IncompleteSolver::IncompleteSolver() : impl_(std::make_unique<Impl>()) {
  impl_->solver.preconditioner().setDroptol(dropped);
  impl_->solver.preconditioner().setFillfactor(fill);
  impl_->solver.setTolerance(1e-14);
  impl_->solver.setMaxIterations(30);
}
IncompleteSolver::~IncompleteSolver() = default;
IncompleteSolver::IncompleteSolver(IncompleteSolver&&) noexcept = default;

bool IncompleteSolver::factor(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a) {
  impl_->solver.compute(a);
  return impl_->solver.info() == Eigen::Success;
}

Eigen::VectorXd IncompleteSolver::solve(const Eigen::VectorXd& b) const { return impl_->solver.solve(b); }

}  // namespace tanktread::membrane
