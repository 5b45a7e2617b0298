#include "coupling/krylov.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>

#include <BelosOperator.hpp>
#include <BelosSolverFactory.hpp>
#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "coupling/agreement.hpp"
#include "coupling/belos_vectors.hpp"
#include "deck/foreign.hpp"

namespace tanktread::coupling {

namespace {

using MultiVector = Belos::MultiVec<double>;
using Operator = Belos::Operator<double>;
using Problem = Belos::LinearProblem<double, MultiVector, Operator>;
using Solver = Belos::SolverManager<double, MultiVector, Operator>;

/// Products of a linear operator with orthonormal vectors, as Krylov methods without preconditioner ask for them.
class KnownProducts {
 public:
  void keep(const Vectors::Column& v, const Vectors::Column& av) {
    if (inputs_.size() == most) return;
    inputs_.emplace_back(v);
    outputs_.emplace_back(av);
  }

  /// Whether x is a sum of the inputs to round-off; then y = A x.
  bool give(const Vectors::Column& x, Vectors::Column y) const {
    Eigen::VectorXd shares(inputs_.size());
    for (std::size_t k = 0; k < inputs_.size(); ++k) shares[static_cast<Eigen::Index>(k)] = inputs_[k].dot(x);
    if (!holds(x, shares)) return false;
    y.setZero();
    for (std::size_t k = 0; k < inputs_.size(); ++k) y += shares[static_cast<Eigen::Index>(k)] * outputs_[k];
    return true;
  }

 private:
  /// Whether x is the sum of so much of each input.
  bool holds(const Vectors::Column& x, const Eigen::VectorXd& shares) const {
    const double size = x.norm();
    if (shares.norm() < (1 - 1e-8) * size) return false;
    Eigen::VectorXd rest = x;
    for (std::size_t k = 0; k < inputs_.size(); ++k) rest -= shares[static_cast<Eigen::Index>(k)] * inputs_[k];
    return rest.norm() <= 1e-12 * size;
  }

  static constexpr std::size_t most = 32;
  std::vector<Eigen::VectorXd> inputs_, outputs_;
};

/// A function on flat arrays as an operator of Belos, which multiplies a start of zeros too, and its solution to see the true residual: these
/// products are known.
class FunctionOperator : public Operator {
 public:
  explicit FunctionOperator(const Krylov::Apply& apply) : apply_(apply) {}
  void Apply(const MultiVector& x, MultiVector& y, Belos::ETrans) const override {
    for (int c = 0; c < x.GetNumberVecs(); ++c) {
      const Vectors::Column in = Vectors::of(x).column(c);
      Vectors::Column out = Vectors::of(y).column(c);
      if (known_.give(in, out)) continue;
      apply_(in.data(), out.data());
      take_first({out.data(), static_cast<std::size_t>(out.size())});
      known_.keep(in, out);
    }
  }

 private:
  const Krylov::Apply& apply_;
  mutable KnownProducts known_;
};

/// Numbers at the ends of the lines "Iter 3, [ 1] : 1.2e-04" that Belos writes.
std::vector<double> residuals(const std::string& log) {
  std::vector<double> found;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const size_t colon = line.rfind(':');
    if (line.find("Iter ") != std::string::npos && line.find("] :") != std::string::npos) {
      found.push_back(std::strtod(line.c_str() + colon + 1, nullptr));
    }
  }
  return found;
}

/// What Belos says, and how, is for `log` alone: it is read for residuals, and some of it asks MPI, which may not be there.
void check_output_not_given(const Teuchos::ParameterList& given) {
  for (const char* name : {"Verbosity", "Output Style", "Output Frequency"})
    if (given.isParameter(name))
      throw UserError(std::string("Solvers/Belos/") + name + " cannot be set: only the program hears what Belos says.");
}

}  // namespace

struct Krylov::Impl {
  Teuchos::RCP<Teuchos::ParameterList> list = Teuchos::rcp(new Teuchos::ParameterList("Belos"));
  Teuchos::RCP<Solver> solver;
  std::string name;
  std::ostringstream log;
  double tolerance = -1;  // as the solver knows it
  void ask(double wanted) {
    if (tolerance == wanted) return;
    const auto now = Teuchos::rcp(new Teuchos::ParameterList(*list));
    now->set("Convergence Tolerance", tolerance = wanted);
    solver->setParameters(now);
  }
};

Krylov::Krylov(std::string solver, std::shared_ptr<Teuchos::ParameterList> list) : impl_(std::make_unique<Impl>()) {
  impl_->name = std::move(solver);
  impl_->list->set("Maximum Iterations", 200);
  impl_->list->set("Verbosity", static_cast<int>(Belos::StatusTestDetails));  // heard by `log`, for the residual history
  impl_->list->set("Output Style", static_cast<int>(Belos::Brief));
  impl_->list->set("Output Frequency", 1);
  impl_->list->set("Output Stream", Teuchos::RCP<std::ostream>(Teuchos::rcpFromRef(impl_->log)));
  if (impl_->name.find("GMRES") != std::string::npos) impl_->list->set("Num Blocks", 200);
  try {
    Belos::SolverFactory<double, MultiVector, Operator> factory;
    const Teuchos::RCP<const Teuchos::ParameterList> valid = factory.create(impl_->name, Teuchos::parameterList())->getValidParameters();
    for (const char* scaling : {"Implicit Residual Scaling", "Explicit Residual Scaling"})  // a start may be right to round-off
      if (valid->isParameter(scaling)) impl_->list->set(scaling, "Norm of RHS");
    if (list) {
      deck::check_foreign("Solvers/Belos", *list, *valid);
      check_output_not_given(*list);
      impl_->list->setParameters(*list);
    }
    impl_->solver = factory.create(impl_->name, impl_->list);
  } catch (const UserError&) {
    throw;
  } catch (const std::exception& error) {
    const std::string text = error.what();
    throw UserError("Solvers/Belos: Belos does not accept the solver '" + impl_->name + "' with the list given: " +
                    text.substr(text.rfind('\n', text.size() - 2) + 1));
  }
}

Krylov::~Krylov() = default;

SolveReport Krylov::solve(const Apply& apply, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance, const Apply& precondition) const {
  const auto left = Teuchos::rcp(new Vectors(b.size(), 1)), right = Teuchos::rcp(new Vectors(b.size(), 1));
  left->column(0) = x;
  right->column(0) = b;
  take_first({left->column(0).data(), static_cast<std::size_t>(x.size())});
  take_first({right->column(0).data(), static_cast<std::size_t>(b.size())});
  if (right->column(0).squaredNorm() == 0) {
    x.setZero();
    return {0, true, {}};
  }
  const auto problem = Teuchos::rcp(new Problem(Teuchos::rcp(new FunctionOperator(apply)), left, right));
  if (precondition) problem->setRightPrec(Teuchos::rcp(new FunctionOperator(precondition)));
  problem->setProblem();
  impl_->log.str({});
  impl_->ask(tolerance);
  impl_->solver->setProblem(problem);
  try {
    const bool converged = impl_->solver->solve() == Belos::Converged;
    x = left->column(0);
    return {impl_->solver->getNumIters(), converged, residuals(impl_->log.str())};
  } catch (const Belos::BelosError&) {  // what Belos makes of numbers that are not finite, or of a basis that breaks down
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
    return {impl_->solver->getNumIters(), false, residuals(impl_->log.str())};
  }
}

void require_convergence(const SolveReport& report, const std::string& system, double tolerance) {
  if (report.converged) return;
  std::ostringstream text;
  text << "the solver did not bring " << system << " to the relative residual " << tolerance << "; residuals:";
  const size_t n = report.history.size(), shown = 12;
  for (size_t i = 0; i < n; ++i)
    if (i == 0 || i + 1 == n || i % std::max<size_t>(1, n / shown) == 0) text << " " << report.history[i] << " (" << i << ")";
  throw RunFailure(text.str());
}

}  // namespace tanktread::coupling
