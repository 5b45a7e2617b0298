#include "system/solvers/krylov.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>

#include <BelosLinearProblem.hpp>
#include <BelosRCGSolMgr.hpp>
#include <BelosSolverFactory_Tpetra.hpp>
#include <BelosTpetraAdapter.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <Teuchos_oblackholestream.hpp>

#include "base/errors.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"
#include "system/solvers/belos_choice.hpp"
#include "system/solvers/chosen_preconditioner.hpp"
#include "system/solvers/vectors.hpp"

namespace tanktread::coupling {

namespace {

using Problem = Belos::LinearProblem<double, Vectors, Operator>;
using Solver = Belos::SolverManager<double, Vectors, Operator>;

constexpr double least_recursive_residual =
    1e-12;  // relative residual below which the residual that Belos updates recursively is only round-off

Teuchos::RCP<Solver> belos_solver(const std::string& name, const Teuchos::RCP<Teuchos::ParameterList>& list) {
  if (name == "RCG") {  // missing in the factory for Tpetra vectors
    const auto solver = Teuchos::rcp(new Belos::RCGSolMgr<double, Vectors, Operator>);
    if (!list.is_null()) solver->setParameters(list);
    return solver;
  }
  return Belos::SolverFactory<double, Vectors, Operator>().create(name, list);
}

/// Disables Trilinos' timers. Without MPI, the timers make a system call in each vector operation, which takes a third of the time of a small solve.
struct Timers : Teuchos::TimeMonitor {
  static void stop() {
    static std::size_t stopped = 0;
    if (counters().size() == stopped) return;
    for (const auto& [name, timer] : counters()) timer->disable();
    stopped = counters().size();
  }
};

/// Returns, for each block, the norm of its part of b - A x, divided by |b|.
std::vector<std::pair<std::string, double>> residuals_of(const LinearSystem& system, const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  Eigen::VectorXd ax(x.size());
  system.product(x.data(), ax.data());
  std::vector<std::pair<std::string, double>> residuals;
  Eigen::Index first = 0;
  for (const Block& block : system.blocks) {
    residuals.emplace_back(block.name, (b - ax).segment(first, block.size()).norm() / b.norm());
    first += block.size();
  }
  return residuals;
}

}  // namespace

BelosChoice belos_choice(const IterativeOptions& options) {
  std::string name = *options.solver;
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (const std::vector<std::string> names = Krylov::names(); std::ranges::find(names, name) == names.end())
    throw UserError(options.path + "/iterative solver must be the name of a solver of Belos that can be used here, as " +
                    deck::alternatives(Krylov::names()) + ", but is " + deck::in_quotes(deck::shortened(*options.solver, 80)) + ".");
  BelosChoice choice{name, Teuchos::rcp(new Teuchos::ParameterList), name == "GMRES" || name == "FLEXIBLE GMRES"};
  if (choice.flexible) choice.name = "BLOCK GMRES";  // Belos' own "GMRES" is another method, which is not flexible
  choice.list->set("Maximum Iterations", 200);
  if (name.ends_with("GMRES")) choice.list->set("Num Blocks", options.restart);
  if (choice.flexible) choice.list->set("Flexible Gmres", true);
  if (!options.belos) return choice;
  const std::string path = options.path + "/Belos";
  deck::check_foreign(path, *options.belos, *belos_solver(choice.name, Teuchos::null)->getValidParameters());
  for (const char* output : {"Verbosity", "Output Style", "Output Frequency"})
    if (options.belos->isParameter(output))
      throw UserError(path + "/" + output + " cannot be set, because the output of Belos is not shown.");
  choice.list->setParameters(*options.belos);
  return choice;
}

struct Krylov::Impl {
  BelosChoice belos;
  ChosenPreconditioner chosen;
  long generation = 0;  // value of generation_ at the latest solve
  std::vector<Block> blocks;
  Teuchos::RCP<FunctionOperator> product, preconditioner;
  Teuchos::RCP<Vectors> unknowns, right;
  Teuchos::RCP<Problem> problem;
  Teuchos::RCP<Solver> solver;

  void prepare(const LinearSystem& system) {
    if (solver.is_null() || blocks != system.blocks || problem->getRightPrec().is_null() == (belos.flexible || system.precondition)) {
      blocks = system.blocks;
      chosen.forget();
      const auto map = replicated(std::accumulate(blocks.begin(), blocks.end(), Eigen::Index(0),
                                                  [](Eigen::Index sum, const Block& block) { return sum + block.size(); }));
      unknowns = Teuchos::rcp(new Vectors(map, 1));
      right = Teuchos::rcp(new Vectors(map, 1));
      product = Teuchos::rcp(new FunctionOperator(map));
      preconditioner = Teuchos::rcp(new FunctionOperator(map));
      problem = Teuchos::rcp(new Problem(product, unknowns, right));
      if (belos.flexible || system.precondition) problem->setRightPrec(preconditioner);  // without one, block GMRES is no longer flexible
      solver = belos_solver(belos.name, Teuchos::rcp(new Teuchos::ParameterList(*belos.list)));
      solver->setProblem(problem);
    }
    product->function = system.product;
    preconditioner->function = system.precondition;
  }

  /// Sets the tolerance, relative to the norm of the right-hand side. (Belos' own default refers to the norm of the initial residual.)
  void set_tolerance(double tolerance) const {
    const auto list = Teuchos::rcp(new Teuchos::ParameterList);
    list->set("Convergence Tolerance", tolerance);
    list->set("Output Stream", Teuchos::RCP<std::ostream>(new Teuchos::oblackholestream));
    const auto valid = solver->getValidParameters();
    for (const char* scaling : {"Implicit Residual Scaling", "Explicit Residual Scaling", "Residual Scaling"})
      if (valid->isParameter(scaling)) list->set(scaling, std::string("Norm of RHS"));
    solver->setParameters(list);
  }
};

std::vector<std::string> Krylov::names() {
  return {"BICGSTAB", "BLOCK CG",       "BLOCK GMRES",       "CG",  "FIXED POINT", "FLEXIBLE GMRES", "GCRODR", "GMRES",
          "MINRES",   "PSEUDOBLOCK CG", "PSEUDOBLOCK GMRES", "RCG", "TFQMR"};
}

Krylov::Krylov(const IterativeOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->belos = belos_choice(options);
  impl_->chosen = ChosenPreconditioner(options.preconditioner);
}

Krylov::~Krylov() = default;

bool Krylov::flexible() const { return impl_->belos.flexible; }

bool Krylov::uses_own_preconditioner() const { return impl_->chosen.keeps_own(); }

SolveReport Krylov::solve(const LinearSystem& system, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) const {
  if (std::exchange(impl_->generation, generation_) != generation_) impl_->chosen.forget();
  impl_->prepare(impl_->chosen.join(system));
  set_column(*impl_->unknowns, 0, x);
  set_column(*impl_->right, 0, b);
  if (column(*impl_->right).squaredNorm() == 0) {
    x.setZero();
    return {0, true, {}};
  }
  SolveReport report;
  impl_->set_tolerance(tolerance);
  impl_->problem->setProblem();
  try {
    report.converged = impl_->solver->solve() == Belos::Converged;
    Timers::stop();
    report.iterations = impl_->solver->getNumIters();
    x = column(*impl_->unknowns);
  } catch (const Belos::BelosError&) {  // thrown if values are not finite or a Krylov basis breaks down
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  impl_->chosen.refresh();
  report.converged = report.converged && x.allFinite();
  const bool in_doubt = report.converged && tolerance < least_recursive_residual;
  if (report.converged && !in_doubt) return report;
  report.residuals = residuals_of(system, b, x);
  report.converged = in_doubt && std::ranges::all_of(report.residuals, [&](const auto& residual) { return residual.second <= 2 * tolerance; });
  return report;
}

void require_convergence(const SolveReport& report, const std::string& system, double tolerance) {
  if (report.converged) return;
  std::ostringstream text;
  text << "the solver did not bring " << system << " to the relative residual " << tolerance << ": after " << report.iterations << " iterations";
  const char* separator = " it is ";
  for (const auto& [name, residual] : report.residuals) text << std::exchange(separator, ", ") << residual << " of the " << name;
  throw RunFailure(text.str());
}

}  // namespace tanktread::coupling
