// Trials of the solvers that the deck names, on small systems before the run (try_solvers).
#include "system/solvers/options.hpp"

#include <functional>
#include <stdexcept>

#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"
#include "membrane/direct_solver.hpp"
#include "system/solvers/krylov.hpp"
#include "system/solvers/nonlinear.hpp"

namespace tanktread::coupling {

namespace {

using List = Teuchos::ParameterList;
using Works = std::function<bool(const List&)>;

constexpr Eigen::Index n = 60;           // number of unknowns of the trial, larger than the number of products stored by class Krylov
constexpr int most_products = 10 * n;  // number of matrix-vector products after which a method counts as not converging

/// Returns the result of a trial solve, or false if a library throws an exception.
bool runs(const std::function<bool()>& trial) {
  try {
    return trial();
  } catch (const std::exception&) {
  } catch (const char*) {  // thrown by NOX
  }
  return false;
}

/// Returns a symmetric, positive definite and diagonally dominant matrix, with which every method converges if its parameters are usable.
Eigen::SparseMatrix<double> system_matrix() {
  Eigen::SparseMatrix<double> a(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.insert(i, i) = 4 + 0.1 * static_cast<double>(i);
    if (i > 0) a.insert(i, i - 1) = a.insert(i - 1, i) = -1;
  }
  a.makeCompressed();
  return a;
}

bool solves(IterativeOptions options, const List& list) {
  return runs([&] {
    options.belos = std::make_shared<List>(list);
    const Krylov krylov(options);
    const Eigen::SparseMatrix<double> a = system_matrix();
    int products = 0;
    const auto apply = [&](const double* in, double* out) {
      if (++products > most_products) throw std::runtime_error("this method does not converge");
      Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
    };
    const auto precondition = [](const double* in, double* out) {
      Eigen::Map<Eigen::VectorXd>(out, n) = 0.25 * Eigen::Map<const Eigen::VectorXd>(in, n);
    };
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n), y = x;
    krylov.solve({one_block("unknowns", n), apply, {}}, Eigen::VectorXd::Ones(n), x, 1e-6);
    krylov.solve({one_block("unknowns", n), apply, precondition}, Eigen::VectorXd::Ones(n), y, 1e-6);
    return x.allFinite() && y.allFinite();
  });
}

/// Adds the parameters in `given` one by one to `grown`, the sublist of `whole` at `path`, until works(whole) is false. Returns the path and value of
/// the parameter added last, or an empty text if works(whole) remains true.
std::string culprit(const List& given, const Works& works, const std::string& path, const List& whole, List& grown) {
  for (const auto& item : given) {
    const std::string here = path + "/" + item.first;
    if (item.second.isList()) {
      const std::string inner = culprit(given.sublist(item.first), works, here, whole, grown.sublist(item.first));
      if (!inner.empty()) return inner;
    } else {
      grown.setEntry(item.first, item.second);
      if (!works(whole)) return here + ", which is " + deck::description(item.second);
    }
  }
  return {};
}

[[noreturn]] void refuse(const std::string& path, const std::string& library, const List& given, const Works& works) {
  List whole(given.name());
  const std::string found = culprit(given, works, path, whole, whole);
  throw UserError(library + " cannot solve with " + (found.empty() ? path : found) + ".");
}

void try_iterative(const IterativeOptions& options) {
  const Krylov known(options);
  const List list = options.belos ? *options.belos : List();
  const Works works = [&](const List& some) { return solves(options, some); };
  if (works(list)) return;
  if (!works(List()))
    throw UserError(options.path + ": the solver " + *options.solver + " cannot be used with the preconditioner " + options.preconditioner + ".");
  refuse(options.path + "/Belos", "Belos", list, works);
}

void try_direct(const membrane::DirectSolverOptions& options) {
  const auto trial = [&options](const List& list) {
    membrane::DirectSolver solver({"direct", options.name, std::make_shared<List>(list)});
    solver.factor(system_matrix());
    return true;
  };
  const Works works = [&](const List& list) { return runs([&] { return trial(list); }); };
  const List list = options.amesos2 ? *options.amesos2 : List();
  try {
    trial(list);
  } catch (const UserError&) {
    throw;
  } catch (const std::exception&) {
    if (!works(List())) throw UserError("Solvers/direct solver: Amesos2's " + options.name + " cannot be used here.");
    refuse("Solvers/Amesos2", "Amesos2", list, works);
  }
}

void try_nonlinear(const std::string& method, const List& list) {
  const auto solve = [&](const List& some, std::string& unread) {
    const FixedPoint solver(method, std::make_shared<List>(some));
    State x(std::make_shared<Layout>(std::vector<Block>{{.name = "unknowns", .rows = n / 3}}));
    x.numbers().setOnes();
    const auto report = solver.solve([](const State& y) -> State { return 0.5 * y; }, [](const State& y) { return y.norm(); }, 1e-8, 1000, x);
    unread = solver.unread();
    return report.converged;
  };
  std::string unread;
  const Works works = [&](const List& some) { return runs([&] { return solve(some, unread); }); };
  if (!works(list)) refuse("Solvers/NOX", "NOX", list, works);
  if (!unread.empty()) throw UserError("Solvers/NOX/" + unread + " is not a parameter that NOX uses with these settings.");
}

}  // namespace

void try_solvers(const SolverOptions& solvers, const std::string& nonlinear_solver) {
  const auto given = [](const auto& list) { return list && list->numParams() > 0; };
  const SolverOptions defaults;
  if (solvers.krylov != defaults.krylov || given(solvers.belos)) try_iterative(solvers.of({}));
  for (const IterativeOptions* system : solvers.systems())
    if (system->solver || given(system->belos) || system->preconditioner != "own") try_iterative(solvers.of(*system));
  if (solvers.direct.name != defaults.direct.name || given(solvers.direct.amesos2)) try_direct(solvers.direct);
  if (given(solvers.nox)) try_nonlinear(nonlinear_solver, *solvers.nox);
}

}  // namespace tanktread::coupling
