#include "coupling/nonlinear.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <NOX.H>
#include <NOX_Abstract_Group.H>
#include <NOX_LAPACK_Vector.H>
#include <NOX_Solver_Factory.H>
#include <NOX_StatusTest_Generic.H>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_oblackholestream.hpp>

#include "base/errors.hpp"
#include "coupling/krylov.hpp"

namespace tanktread::coupling {

namespace {

using Vector = NOX::LAPACK::Vector;

const Vector& ours(const NOX::Abstract::Vector& vector) { return dynamic_cast<const Vector&>(vector); }

Net net(const Vector& vector) {
  Net result(static_cast<Eigen::Index>(vector.length()) / 3, 3);
  for (Eigen::Index i = 0; i < result.size(); ++i) result.data()[i] = vector(static_cast<int>(i));
  return result;
}

Vector vector(const Net& net) { return Vector(static_cast<int>(net.size()), const_cast<double*>(net.data())); }  // copies

/// g, its norm and the linear solver that a Newton step takes.
struct System {
  const FixedPoint::Map& g;
  const FixedPoint::Norm& norm;
  const Krylov& krylov;
};

/// F(x) = g(x) - x as NOX sees it.
class Group : public NOX::Abstract::Group {
 public:
  Group(const System& system, const Net& x) : system_(system), x_(vector(x)), f_(x_), newton_(x_) {}

  NOX::Abstract::Group& operator=(const NOX::Abstract::Group& source) override {
    const Group& other = dynamic_cast<const Group&>(source);
    x_ = other.x_;
    f_ = other.f_;
    newton_ = other.newton_;
    has_f_ = other.has_f_;
    has_newton_ = other.has_newton_;
    return *this;
  }
  void setX(const NOX::Abstract::Vector& y) override { x_ = y, has_f_ = has_newton_ = false; }
  void computeX(const NOX::Abstract::Group& from, const NOX::Abstract::Vector& d, double step) override {
    x_.update(1, from.getX(), step, d);
    has_f_ = has_newton_ = false;
  }
  ReturnType computeF() override {
    if (has_f_) return Ok;
    const Net x = net(x_), f = system_.g(x) - x;
    if (!f.allFinite()) return Failed;
    f_ = vector(f);
    has_f_ = true;
    return Ok;
  }
  ReturnType computeJacobian() override { return computeF(); }

  /// F + F' d = 0, products by differences above the noise of adaptive quadrature.
  ReturnType computeNewton(Teuchos::ParameterList& list) override {
    if (computeF() != Ok) return Failed;
    const Net x = net(x_), f = net(f_);
    const auto apply = [&](const double* in, double* out) {
      const Net direction = Eigen::Map<const Net>(in, x.rows(), 3);
      const double size = system_.norm(direction), e = size > 0 ? 1e-4 / size : 1;
      const Net y = x + e * direction;
      Eigen::Map<Net>(out, x.rows(), 3) = (system_.g(y) - y - f) / e;
    };
    Eigen::VectorXd d = Eigen::VectorXd::Zero(x.size());
    const SolveReport report = system_.krylov.solve(apply, -Eigen::Map<const Eigen::VectorXd>(f.data(), f.size()), d, list.get("Tolerance", 0.1));
    if (!d.allFinite()) return Failed;
    newton_ = vector(Eigen::Map<const Net>(d.data(), x.rows(), 3));
    has_newton_ = true;
    return report.converged ? Ok : NotConverged;
  }
  bool isF() const override { return has_f_; }
  bool isJacobian() const override { return has_f_; }
  bool isNewton() const override { return has_newton_; }
  const NOX::Abstract::Vector& getX() const override { return x_; }
  const NOX::Abstract::Vector& getF() const override { return f_; }
  double getNormF() const override { return f_.norm(); }
  const NOX::Abstract::Vector& getGradient() const override { throw std::logic_error("no gradient"); }
  const NOX::Abstract::Vector& getNewton() const override { return newton_; }
  Teuchos::RCP<const NOX::Abstract::Vector> getXPtr() const override { return Teuchos::rcpFromRef(x_); }
  Teuchos::RCP<const NOX::Abstract::Vector> getFPtr() const override { return Teuchos::rcpFromRef(f_); }
  Teuchos::RCP<const NOX::Abstract::Vector> getGradientPtr() const override { return {}; }
  Teuchos::RCP<const NOX::Abstract::Vector> getNewtonPtr() const override { return Teuchos::rcpFromRef(newton_); }
  Teuchos::RCP<NOX::Abstract::Group> clone(NOX::CopyType) const override { return Teuchos::rcp(new Group(*this)); }

 private:
  const System& system_;
  Vector x_, f_, newton_;
  bool has_f_ = false, has_newton_ = false;
};

/// Ends at the tolerance, in our norm, or after so many iterations.
class Test : public NOX::StatusTest::Generic {
 public:
  Test(const FixedPoint::Norm& norm, double tolerance, int most) : norm_(norm), tolerance_(tolerance), most_(most) {}
  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic& solver, NOX::StatusTest::CheckType) override {
    const NOX::Abstract::Group& group = solver.getSolutionGroup();
    if (group.isF() && norm_(net(ours(group.getF()))) <= tolerance_) return status_ = NOX::StatusTest::Converged;
    return status_ = !group.isF() || solver.getNumIterations() >= most_ ? NOX::StatusTest::Failed : NOX::StatusTest::Unconverged;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream& print(std::ostream& stream, int) const override { return stream; }

 private:
  const FixedPoint::Norm& norm_;
  double tolerance_;
  int most_;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// A copy of which nothing is marked as looked at.
Teuchos::ParameterList unread_copy(const Teuchos::ParameterList& list) {
  Teuchos::ParameterList copy(list.name());
  for (const auto& item : list) {
    Teuchos::ParameterEntry fresh;
    fresh.setAnyValue(item.second.getAny(false));
    if (item.second.isList())
      copy.sublist(item.first) = unread_copy(list.sublist(item.first));
    else
      copy.setEntry(item.first, fresh);
  }
  return copy;
}

/// The path in `list` of a parameter of `given` that nobody has looked at; empty: none.
std::string unread_path(const Teuchos::ParameterList& given, const Teuchos::ParameterList& list) {
  for (const auto& item : given) {
    if (!item.second.isList()) {
      if (!list.getEntry(item.first).isUsed()) return item.first;
    } else if (const std::string inner = unread_path(given.sublist(item.first), list.sublist(item.first)); !inner.empty()) {
      return item.first + "/" + inner;
    }
  }
  return {};
}

Teuchos::ParameterList defaults(const std::string& method) {
  Teuchos::ParameterList list("NOX");
  const Teuchos::RCP<std::ostream> nowhere = Teuchos::rcp(new Teuchos::oblackholestream);  // a step that fails is tried again, shorter
  list.sublist("Printing").set("Output Information", 0).set("Output Stream", nowhere).set("Error Stream", nowhere);
  if (method == "anderson") {
    list.set("Nonlinear Solver", "Anderson Accelerated Fixed-Point");
    list.sublist("Anderson Parameters").set("Storage Depth", 4);
    return list;
  }
  list.set("Nonlinear Solver", "Line Search Based");
  list.sublist("Line Search").set("Method", "Full Step");
  auto& newton = list.sublist("Direction").sublist("Newton");
  newton.set("Forcing Term Method", "Constant");
  newton.sublist("Linear Solver").set("Tolerance", 0.1);
  return list;
}

}  // namespace

struct FixedPoint::Impl {
  Teuchos::ParameterList given, list;
  Teuchos::RCP<Teuchos::ParameterList> last;  // as the last solve has left it
  Krylov krylov{"GMRES", nullptr};
};

FixedPoint::FixedPoint(std::string method, const std::shared_ptr<Teuchos::ParameterList>& list) : impl_(std::make_unique<Impl>()) {
  impl_->list = defaults(method);
  if (list) impl_->list.setParameters(impl_->given = unread_copy(*list));
}

FixedPoint::~FixedPoint() = default;

std::string FixedPoint::unread() const { return impl_->last ? unread_path(impl_->given, *impl_->last) : std::string(); }

NonlinearReport FixedPoint::solve(const Map& g, const Norm& norm, double tolerance, int most, Net& x) const {
  const System system{g, norm, impl_->krylov};
  const auto group = Teuchos::rcp(new Group(system, x));
  const auto list = impl_->last = Teuchos::rcp(new Teuchos::ParameterList(impl_->list));
  auto& anderson = list->sublist("Anderson Parameters");
  if (anderson.isType<int>("Storage Depth")) anderson.set("Storage Depth", std::min(anderson.get<int>("Storage Depth"), static_cast<int>(x.size())));
  try {
    const auto solver = NOX::Solver::buildSolver(group, Teuchos::rcp(new Test(norm, tolerance, most)), list);
    const bool converged = solver->solve() == NOX::StatusTest::Converged;
    x = net(ours(solver->getSolutionGroup().getX()));
    return {solver->getNumIterations(), converged};
  } catch (const char*) {  // NOX's word for a function or a direction that cannot be had
    return {0, false};
  } catch (const Teuchos::Exceptions::InvalidParameter& error) {
    throw UserError(std::string("Solvers/NOX: NOX does not accept the list: ") + error.what());
  }
}

}  // namespace tanktread::coupling
