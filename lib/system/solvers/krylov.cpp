#include "system/solvers/krylov.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <Thyra_BelosLinearOpWithSolveFactory_decl.hpp>
#include <Thyra_DefaultIdentityLinearOp.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>

#include "base/errors.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"
#include "system/solvers/chosen_preconditioner.hpp"
#include "system/solvers/thyra_blocks.hpp"

namespace tanktread::coupling {

namespace {

constexpr const char* block_gmres = "Block GMRES";

constexpr double least_recursive_residual = 1e-12;  // relative residual below which the residual that Belos updates recursively is only round-off

/// Returns a map from the names of Belos' factory to the names of Stratimikos. "GMRES" is mapped to flexible GMRES, which detects convergence without
/// an additional product.
const std::map<std::string, std::string>& solver_types() {
  static const std::map<std::string, std::string> types = {{"GMRES", block_gmres},
                                                           {"FLEXIBLE GMRES", block_gmres},
                                                           {"BLOCK GMRES", block_gmres},
                                                           {"PSEUDOBLOCK GMRES", "Pseudo Block GMRES"},
                                                           {"GCRODR", "GCRODR"},
                                                           {"BICGSTAB", "BiCGStab"},
                                                           {"TFQMR", "TFQMR"},
                                                           {"CG", "Pseudo Block CG"},
                                                           {"PSEUDOBLOCK CG", "Pseudo Block CG"},
                                                           {"BLOCK CG", "Block CG"},
                                                           {"MINRES", "MINRES"},
                                                           {"RCG", "RCG"},
                                                           {"FIXED POINT", "Fixed Point"}};
  return types;
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
  for (const UnknownBlock& block : system.blocks) {
    residuals.emplace_back(block.name, (b - ax).segment(first, block.size).norm() / b.norm());
    first += block.size;
  }
  return residuals;
}

}  // namespace

BelosFactory belos_factory(const IterativeOptions& options) {
  std::string name = *options.solver;
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const auto type = solver_types().find(name);
  if (type == solver_types().end())
    throw UserError(options.path + "/iterative solver must be the name of a solver of Belos that can be used here, as " +
                    deck::alternatives(Krylov::names()) + ", but is " + deck::in_quotes(deck::shortened(*options.solver, 80)) + ".");
  const auto factory = Teuchos::rcp(new Thyra::BelosLinearOpWithSolveFactory<double>);
  const auto all = Teuchos::rcp(new Teuchos::ParameterList);
  all->set("Solver Type", type->second);
  Teuchos::ParameterList& own = all->sublist("Solver Types").sublist(type->second);
  own.set("Maximum Iterations", 200);
  if (name.ends_with("GMRES")) own.set("Num Blocks", options.restart);
  const bool flexible = name == "GMRES" || name == "FLEXIBLE GMRES";
  if (flexible) own.set("Flexible Gmres", true);
  if (options.belos) {
    const std::string path = options.path + "/Belos";
    deck::check_foreign(path, *options.belos, factory->getValidParameters()->sublist("Solver Types").sublist(type->second));
    for (const char* output : {"Verbosity", "Output Style", "Output Frequency"})
      if (options.belos->isParameter(output))
        throw UserError(path + "/" + output + " cannot be set, because the output of Belos is not shown.");
    own.setParameters(*options.belos);
  }
  factory->setParameterList(all);
  return {factory, flexible};
}

struct Krylov::Impl {
  BelosFactory belos;
  ChosenPreconditioner chosen;
  long generation = 0;  // value of generation_ at the latest solve
  Blocks blocks;
  Teuchos::RCP<const Space> space;
  Teuchos::RCP<FunctionOperator> product, preconditioner;
  Teuchos::RCP<ThyraVector> unknowns, right;
  Teuchos::RCP<Thyra::LinearOpWithSolveBase<double>> solver;

  void prepare(const LinearSystem& system) {
    if (space.is_null() || blocks != system.blocks || preconditioner.is_null() == bool(system.precondition)) {
      blocks = system.blocks;
      chosen.forget();
      space = vector_space(blocks);
      unknowns = Thyra::createMember(space);
      right = Thyra::createMember(space);
      product = Teuchos::rcp(new FunctionOperator(space));
      preconditioner = system.precondition ? Teuchos::rcp(new FunctionOperator(space)) : Teuchos::null;
      solver = belos.factory->createOp();
      Teuchos::RCP<const Thyra::LinearOpBase<double>> from_right = preconditioner;
      if (belos.flexible && !system.precondition) from_right = Thyra::identity<double>(space);
      if (from_right.is_null())
        Thyra::initializeOp<double>(*belos.factory, product, solver.ptr());
      else
        Thyra::initializePreconditionedOp<double>(*belos.factory, product, Thyra::rightPrec<double>(from_right), solver.ptr());
    }
    product->function = system.product;
    if (!preconditioner.is_null()) preconditioner->function = system.precondition;
  }
};

std::vector<std::string> Krylov::names() {
  std::vector<std::string> names;
  for (const auto& [name, type] : solver_types()) names.push_back(name);
  return names;
}

Krylov::Krylov(const IterativeOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->belos = belos_factory(options);
  impl_->chosen = ChosenPreconditioner(options.preconditioner);
}

Krylov::~Krylov() = default;

bool Krylov::flexible() const { return impl_->belos.flexible; }

bool Krylov::uses_own_preconditioner() const { return impl_->chosen.keeps_own(); }

SolveReport Krylov::solve(const LinearSystem& system, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) const {
  if (std::exchange(impl_->generation, generation_) != generation_) impl_->chosen.forget();
  impl_->prepare(impl_->chosen.join(system));
  const Teuchos::RCP<ThyraVector>&unknowns = impl_->unknowns, &right = impl_->right;
  set(unknowns, x);
  set(right, b);
  if (numbers_of(*right).squaredNorm() == 0) {
    x.setZero();
    return {0, true, {}};
  }
  const Thyra::SolveCriteria<double> criteria({Thyra::SOLVE_MEASURE_NORM_RESIDUAL, Thyra::SOLVE_MEASURE_NORM_RHS}, tolerance);
  SolveReport report;
  try {
    const auto status = Thyra::solve<double>(*impl_->solver, Thyra::NOTRANS, *right, unknowns.ptr(), Teuchos::constOptInArg(criteria));
    Timers::stop();
    report.iterations = status.extraParameters->get<int>("Iteration Count");
    report.converged = status.solveStatus == Thyra::SOLVE_STATUS_CONVERGED;
    x = numbers_of(*unknowns);
  } catch (const Thyra::CatastrophicSolveFailure&) {  // thrown by Belos if values are not finite or a Krylov basis breaks down
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
