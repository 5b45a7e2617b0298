#include "system/solvers/nonlinear.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <typeinfo>

#include <NOX.H>
#include <NOX_Solver_Factory.H>
#include <NOX_StatusTest_Generic.H>
#include <NOX_Thyra_Group.H>
#include <NOX_Thyra_Vector.H>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_oblackholestream.hpp>
#include <Thyra_BelosLinearOpWithSolveFactory_decl.hpp>
#include <Thyra_DefaultIdentityLinearOp.hpp>
#include <Thyra_DefaultPreconditioner.hpp>
#include <Thyra_DefaultSpmdVectorSpace.hpp>
#include <Thyra_DetachedVectorView.hpp>
#include <Thyra_StateFuncModelEvaluatorBase.hpp>
#include <Thyra_VectorStdOps.hpp>

#include "base/errors.hpp"
#include "system/solvers/belos_choice.hpp"
#include "system/solvers/chosen_preconditioner.hpp"
#include "system/solvers/vectors.hpp"

namespace tanktread::coupling {

namespace {

// NOX needs Thyra: vectors, operators and linear solvers. Every rank holds all numbers, as in vectors.hpp.
using Space = Thyra::VectorSpaceBase<double>;
using ThyraVector = Thyra::VectorBase<double>;

Teuchos::RCP<const Space> vector_space(Eigen::Index n) {
  return Thyra::defaultSpmdVectorSpace<double>(Teuchos::rcp(new Teuchos::SerialComm<Thyra::Ordinal>), n, n);
}

Eigen::VectorXd numbers_of(const ThyraVector& vector) {
  const Thyra::ConstDetachedVectorView<double> view(vector);
  return Eigen::Map<const Eigen::VectorXd>(view.values(), view.subDim());
}

/// Returns a vector with the numbers of the first rank.
Teuchos::RCP<ThyraVector> vector_of(const Teuchos::RCP<const Space>& space, const Eigen::VectorXd& numbers) {
  const Teuchos::RCP<ThyraVector> vector = Thyra::createMember(space);
  set_together(Thyra::DetachedVectorView<double>(vector).values(), numbers);
  return vector;
}

/// Linear operator defined by a function (apply_together).
class ThyraOperator : public Thyra::LinearOpBase<double> {
 public:
  explicit ThyraOperator(Teuchos::RCP<const Space> space) : space_(std::move(space)) {}

  Apply function;

  Teuchos::RCP<const Space> range() const override { return space_; }
  Teuchos::RCP<const Space> domain() const override { return space_; }

 private:
  bool opSupportedImpl(Thyra::EOpTransp transpose) const override { return transpose == Thyra::NOTRANS; }
  void applyImpl(Thyra::EOpTransp, const Thyra::MultiVectorBase<double>& x, const Teuchos::Ptr<Thyra::MultiVectorBase<double>>& y,
                 double alpha, double beta) const override {
    Eigen::VectorXd image(space_->dim());
    for (Thyra::Ordinal c = 0; c < x.domain()->dim(); ++c) {
      const Thyra::ConstDetachedVectorView<double> in(x.col(c));
      const Thyra::DetachedVectorView<double> out(y->col(c));
      apply_together(function, image.size(), in.values(), image.data());
      Eigen::Map<Eigen::VectorXd> result(out.values(), image.size());
      result = beta == 0 ? Eigen::VectorXd(alpha * image) : Eigen::VectorXd(alpha * image + beta * result);
    }
  }

  Teuchos::RCP<const Space> space_;
};

/// Returns a factory of linear solvers of Belos for the systems of Newton's method.
Teuchos::RCP<const Thyra::LinearOpWithSolveFactoryBase<double>> linear_solvers(const IterativeOptions& options) {
  const BelosChoice choice = belos_choice(options);
  const auto plain = [](std::string name) {  // Thyra's names of the solvers differ from those of Belos in spaces and capitals
    std::erase(name, ' ');
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return name;
  };
  const auto factory = Teuchos::rcp(new Thyra::BelosLinearOpWithSolveFactory<double>);
  const auto all = Teuchos::rcp(new Teuchos::ParameterList);
  for (const auto& known : factory->getValidParameters()->sublist("Solver Types"))
    if (plain(known.first) == plain(choice.name)) {
      all->set("Solver Type", known.first);
      all->sublist("Solver Types").sublist(known.first) = *choice.list;
    }
  factory->setParameterList(all);
  return factory;
}

/// Returns the unit in which states and residuals are passed to NOX: 2^-20 times the length of a displacement of norm 1, rounded to a power of 2.
/// The unit is small, so that the numbers are large. With a larger unit, differences of residuals near the solution could be below 1e-16. NOX treats
/// such differences as singular.
double unit_of(const FixedPoint::Norm& norm, const State& x) {
  constexpr double small = 0x1p-20;
  State displacement(x.layout());
  for (std::size_t k = 0; k < x.layout()->blocks().size(); ++k)
    if (x.layout()->blocks()[k].parity == Parity::polar) displacement(BlockId{k}).col(1).setOnes();
  const double size = norm(displacement);
  return size > 0 && std::isfinite(size) ? small * std::exp2(-std::round(std::log2(size))) : small;
}

State state(const std::shared_ptr<const Layout>& layout, const Eigen::VectorXd& numbers, double unit) {
  State x(layout);
  x.numbers() = unit * numbers;
  return x;
}

Eigen::VectorXd numbers(const State& x, double unit) { return x.numbers() / unit; }

/// Residual F(x) = g(x) - x. Products F' d are computed by finite differences, with steps that exceed the noise of adaptive quadrature.
class Model : public Thyra::StateFuncModelEvaluatorBase<double> {
 public:
  using InArgs = Thyra::ModelEvaluatorBase::InArgs<double>;
  using OutArgs = Thyra::ModelEvaluatorBase::OutArgs<double>;

  Model(const FixedPoint::Map& g, const FixedPoint::Norm& norm, double unit, const State& start, const std::string& preconditioner)
      : g_(g), norm_(norm), unit_(unit), layout_(start.layout()), space_(vector_space(layout_->size())), chosen_(preconditioner) {
    if (chosen_.join(LinearSystem()).precondition) preconditioner_ = Teuchos::rcp(new ThyraOperator(space_));
  }

  /// Returns the right preconditioner of Newton's linear systems.
  Teuchos::RCP<const Thyra::LinearOpBase<double>> preconditioner() const {
    if (preconditioner_.is_null()) return Thyra::identity<double>(space_);
    return preconditioner_;
  }

  Teuchos::RCP<const Space> get_x_space() const override { return space_; }
  Teuchos::RCP<const Space> get_f_space() const override { return space_; }
  Teuchos::RCP<Thyra::LinearOpBase<double>> create_W_op() const override { return Teuchos::rcp(new ThyraOperator(space_)); }
  InArgs createInArgs() const override {
    Thyra::ModelEvaluatorBase::InArgsSetup<double> in;
    in.setModelEvalDescription("fixed point");
    in.setSupports(IN_ARG_x);
    return in;
  }

 private:
  OutArgs createOutArgsImpl() const override {
    Thyra::ModelEvaluatorBase::OutArgsSetup<double> out;
    out.setModelEvalDescription("fixed point");
    out.setSupports(OUT_ARG_f);
    out.setSupports(OUT_ARG_W_op);
    return out;
  }

  void evalModelImpl(const InArgs& in, const OutArgs& out) const override {
    const State x = state(layout_, numbers_of(*in.get_x()), unit_);
    if (!(x == x_)) {
      f_ = g_(x) - x;
      x_ = x;
    }
    if (!f_.allFinite()) return out.setFailed();
    if (!out.get_f().is_null()) Thyra::assign(out.get_f().ptr(), *vector_of(space_, numbers(f_, unit_)));
    if (out.get_W_op().is_null()) return;
    chosen_.refresh();
    newton_ = {layout_->blocks(), on_blocks(layout_, [this, x, f = f_](const State& direction) -> State {
      const double size = norm_(direction), e = size > 0 ? 1e-4 / size : 1;
      const State y = x + e * direction;
      return (g_(y) - y - f) / e;
    }), {}};
    const LinearSystem joined = chosen_.join(newton_);
    dynamic_cast<ThyraOperator&>(*out.get_W_op()).function = joined.product;
    if (!preconditioner_.is_null()) preconditioner_->function = joined.precondition;
  }

  const FixedPoint::Map& g_;
  const FixedPoint::Norm& norm_;
  double unit_;
  std::shared_ptr<const Layout> layout_;
  Teuchos::RCP<const Space> space_;
  mutable ChosenPreconditioner chosen_;
  Teuchos::RCP<ThyraOperator> preconditioner_;
  mutable LinearSystem newton_;
  mutable State x_, f_;  // x_: argument of the latest evaluation. f_: residual F(x_)
};

State state(const std::shared_ptr<const Layout>& layout, const NOX::Abstract::Vector& vector, double unit) {
  return state(layout, numbers_of(dynamic_cast<const NOX::Thyra::Vector&>(vector).getThyraVector()), unit);
}

/// Convergence test: stops at the tolerance in the given norm, or after `most` iterations.
class Test : public NOX::StatusTest::Generic {
 public:
  Test(const FixedPoint::Norm& norm, const std::shared_ptr<const Layout>& layout, double unit, double tolerance, int most)
      : norm_(norm), layout_(layout), unit_(unit), tolerance_(tolerance), most_(most) {}
  NOX::StatusTest::StatusType checkStatus(const NOX::Solver::Generic& solver, NOX::StatusTest::CheckType) override {
    const NOX::Abstract::Group& group = solver.getSolutionGroup();
    const double residual = group.isF() ? norm_(state(layout_, group.getF(), unit_)) : std::numeric_limits<double>::quiet_NaN();
    if (residual <= tolerance_) return status_ = NOX::StatusTest::Converged;
    return status_ = !std::isfinite(residual) || solver.getNumIterations() >= most_ ? NOX::StatusTest::Failed : NOX::StatusTest::Unconverged;
  }
  NOX::StatusTest::StatusType getStatus() const override { return status_; }
  std::ostream& print(std::ostream& stream, int) const override { return stream; }

 private:
  const FixedPoint::Norm& norm_;
  std::shared_ptr<const Layout> layout_;
  double unit_, tolerance_;
  int most_;
  NOX::StatusTest::StatusType status_ = NOX::StatusTest::Unevaluated;
};

/// Returns a copy of a list in which no parameter is marked as used.
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

/// Returns the path in `list` of a parameter of `given` that has not been used; empty if all have been used.
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

Teuchos::ParameterList defaults(const std::string& method, int depth) {
  Teuchos::ParameterList list("NOX");
  const Teuchos::RCP<std::ostream> nowhere = Teuchos::rcp(new Teuchos::oblackholestream);  // discards error messages, because a time step that
                                                                                           // fails is repeated with a shorter step
  list.sublist("Printing").set("Output Information", 0).set("Output Stream", nowhere).set("Error Stream", nowhere);
  if (method == "anderson") {
    list.set("Nonlinear Solver", "Anderson Accelerated Fixed-Point");
    list.sublist("Anderson Parameters").set("Storage Depth", depth);
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
  Teuchos::RCP<Teuchos::ParameterList> last;  // parameter list after the last solve
  Teuchos::RCP<const Thyra::LinearOpWithSolveFactoryBase<double>> linear_solver;
  std::string preconditioner;
};

FixedPoint::FixedPoint(std::string method, const std::shared_ptr<Teuchos::ParameterList>& list, const IterativeOptions& linear, int depth)
    : impl_(std::make_unique<Impl>()) {
  impl_->linear_solver = linear_solvers(linear);
  impl_->preconditioner = linear.preconditioner;
  impl_->list = defaults(method, depth);
  if (list) impl_->list.setParameters(impl_->given = unread_copy(*list));
}

FixedPoint::~FixedPoint() = default;

std::string FixedPoint::unread() const { return impl_->last ? unread_path(impl_->given, *impl_->last) : std::string(); }

NonlinearReport FixedPoint::solve(const Map& g, const Norm& norm, double tolerance, int most, State& x, const Norm& residual_norm) const {
  using Teuchos::RCP;
  using Weights = Thyra::VectorBase<double>;
  const double unit = unit_of(norm, x);
  const auto model = Teuchos::rcp(new Model(g, norm, unit, x, impl_->preconditioner));
  const auto start = vector_of(model->get_x_space(), numbers(x, unit));
  const RCP<Thyra::LinearOpBase<double>> derivative = model->create_W_op();
  const auto from_right = Teuchos::rcp(new Thyra::DefaultPreconditioner<double>);
  from_right->initializeRight(model->preconditioner());
  const RCP<Thyra::PreconditionerBase<double>> preconditioner = from_right;
  const RCP<Thyra::PreconditionerFactoryBase<double>> no_factory;
  const RCP<const Weights> unweighted;
  const bool scaled = false, updated = false;
  const auto group =
      Teuchos::rcp(new NOX::Thyra::Group(NOX::Thyra::Vector(start), model, derivative, impl_->linear_solver, preconditioner, no_factory,
                                         unweighted, unweighted, RCP<Weights>(), scaled, updated));
  const auto list = impl_->last = Teuchos::rcp(new Teuchos::ParameterList(impl_->list));
  auto& anderson = list->sublist("Anderson Parameters");
  const auto size = static_cast<int>(x.numbers().size());
  if (anderson.isType<int>("Storage Depth")) anderson.set("Storage Depth", std::min(anderson.get<int>("Storage Depth"), size));
  RCP<NOX::Solver::Generic> solver;
  const auto failed = [&] { return NonlinearReport{solver.is_null() ? 0 : solver->getNumIterations(), false}; };
  try {
    solver = NOX::Solver::buildSolver(group, Teuchos::rcp(new Test(residual_norm ? residual_norm : norm, x.layout(), unit, tolerance, most)), list);
    const bool converged = solver->solve() == NOX::StatusTest::Converged;
    x = state(x.layout(), solver->getSolutionGroup().getX(), unit);
    return {solver->getNumIterations(), converged};
  } catch (const char*) {  // thrown by NOX if the function or a direction cannot be evaluated
    return failed();
  } catch (const Thyra::CatastrophicSolveFailure&) {
    return failed();
  } catch (const std::runtime_error& error) {  // exactly this type: thrown by Anderson's method if differences of iterates are linearly dependent
    if (typeid(error) != typeid(std::runtime_error)) throw;
    return failed();
  } catch (const Teuchos::Exceptions::InvalidParameter& error) {
    throw UserError(std::string("Solvers/NOX: NOX does not accept these parameters: ") + error.what());
  }
}

}  // namespace tanktread::coupling
