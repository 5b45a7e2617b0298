#include "coupling/krylov.hpp"

#include <algorithm>
#include <limits>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_TimeMonitor.hpp>
#include <Thyra_BelosLinearOpWithSolveFactory_decl.hpp>
#include <Thyra_DefaultIdentityLinearOp.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>

#include "base/errors.hpp"
#include "coupling/thyra_blocks.hpp"
#include "deck/foreign.hpp"
#include "deck/words.hpp"

namespace tanktread::coupling {

namespace {

constexpr const char* block_gmres = "Block GMRES";

constexpr double least_recursive_residual = 1e-12;  // below, what a recursion says of the residual is rounding

/// What Stratimikos calls the solvers of Belos' factory. GMRES is the flexible one, which needs no product to see that it has converged.
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

/// Where MPI has not been started Trilinos' timers ask the system, at every operation on vectors: a third of the time of a small solve.
struct Timers : Teuchos::TimeMonitor {
  static void stop() {
    static std::size_t stopped = 0;
    if (counters().size() == stopped) return;
    for (const auto& [name, timer] : counters()) timer->disable();
    stopped = counters().size();
  }
};

Eigen::Index size(const Blocks& blocks) {
  return std::accumulate(blocks.begin(), blocks.end(), Eigen::Index(0), [](Eigen::Index sum, const UnknownBlock& block) { return sum + block.size; });
}

/// |b - A x| of each block over |b|.
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
      if (options.belos->isParameter(output)) throw UserError(path + "/" + output + " cannot be set: nobody hears what Belos says.");
    own.setParameters(*options.belos);
  }
  factory->setParameterList(all);
  return {factory, flexible};
}

namespace {

/// Products y = A z of the solves before, the latest first, y made orthonormal: as a preconditioner Y^T and then Z, and another for the rest   (2.24)
class RecycledProducts {
 public:
  /// A product of the present solve, which counts from the next one on.
  void record(const Eigen::VectorXd& z, const Eigen::VectorXd& y) { present_.push_back({z, y}); }

  /// Ends the present solve.
  void refresh() {
    double zy = 0, yy = 0;
    for (const auto& [z, y] : present_) zy += z.dot(y), yy += y.squaredNorm();
    if (zy > 0) scale_ = zy / yy;
    std::vector<Product> all = std::move(present_);
    all.insert(all.end(), std::make_move_iterator(kept_.begin()), std::make_move_iterator(kept_.end()));
    present_.clear(), kept_.clear();
    for (Product& product : all)
      if (kept_.size() < most) keep(std::move(product));
  }

  /// out = Z Y^T in + P (in - Y Y^T in)
  void apply(const Eigen::VectorXd& in, const Apply& other, Eigen::Map<Eigen::VectorXd> out) const {
    Eigen::VectorXd rest = in, known = Eigen::VectorXd::Zero(in.size());
    for (const auto& [z, y] : kept_) {
      const double share = y.dot(in);
      rest -= share * y;
      known += share * z;
    }
    out = scale_ * rest;
    if (other) other(rest.data(), out.data());
    out += known;
  }

  double scale() const { return scale_; }

 private:
  struct Product {
    Eigen::VectorXd z, y;
  };

  void keep(Product product) {
    const double size = product.y.norm();
    for (int twice = 0; twice < 2; ++twice)
      for (const auto& [z, y] : kept_) {
        const double share = y.dot(product.y);
        product.y -= share * y;
        product.z -= share * z;
      }
    const double rest = product.y.norm();
    if (rest > 0.3 * size) kept_.push_back({product.z / rest, product.y / rest});
  }

  static constexpr std::size_t most = 10;
  std::vector<Product> present_, kept_;
  double scale_ = 1;  // s of the least |z - s y|: one over the size of the operator
};

}  // namespace

struct Krylov::Impl {
  BelosFactory belos;
  std::string kind;  // of the preconditioner
  RecycledProducts recycled;
  Blocks blocks;
  Teuchos::RCP<const Space> space;
  Teuchos::RCP<FunctionOperator> product, preconditioner;
  Teuchos::RCP<Thyra::LinearOpWithSolveBase<double>> solver;

  /// The system with the preconditioner that was chosen for it, which refers to `system`.
  LinearSystem preconditioned(const LinearSystem& system) {
    LinearSystem result = system;
    const Eigen::Index n = size(system.blocks);
    if (kind == "none") result.precondition = {};
    if (kind == "neumann" || kind == "recycled") {
      result.product = [this, &system, n](const double* in, double* out) {
        system.product(in, out);
        recycled.record(Eigen::Map<const Eigen::VectorXd>(in, n), Eigen::Map<Eigen::VectorXd>(out, n));
      };
    }
    if (kind == "neumann")
      result.precondition = [this, &system, n](const double* in, double* out) {
        const double s = recycled.scale();
        system.product(in, out);
        Eigen::Map<Eigen::VectorXd>(out, n) = s * (2 * Eigen::Map<const Eigen::VectorXd>(in, n) - s * Eigen::Map<Eigen::VectorXd>(out, n));
      };
    if (kind == "recycled")
      result.precondition = [this, &system, n](const double* in, double* out) {
        recycled.apply(Eigen::Map<const Eigen::VectorXd>(in, n), system.precondition, {out, n});
      };
    return result;
  }

  void prepare(const LinearSystem& system) {
    if (space.is_null() || blocks != system.blocks || preconditioner.is_null() == bool(system.precondition)) {
      blocks = system.blocks;
      recycled = {};
      space = vector_space(blocks);
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
  impl_->kind = options.preconditioner;
}

Krylov::~Krylov() = default;

SolveReport Krylov::solve(const LinearSystem& system, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) const {
  impl_->prepare(impl_->preconditioned(system));
  const auto unknowns = vector_of(impl_->space, x), right = vector_of(impl_->space, b);
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
  } catch (const Thyra::CatastrophicSolveFailure&) {  // what Belos makes of numbers that are not finite, or of a basis that breaks down
    x.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  impl_->recycled.refresh();
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
