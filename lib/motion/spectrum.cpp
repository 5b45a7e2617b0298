#include "motion/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/QR>

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "system/parallel/agreement.hpp"
#include "system/rigid_motion.hpp"
#include "system/solvers/eigenvalues.hpp"

namespace tanktread::motion {

void SpectrumOptions::declare(deck::Section& section) {
  section.key("number", number, deck::between(1, 500), "1",
              "number of reported eigenmodes of the steady shape. They are ordered from the fastest growing to the fastest decaying one");
  section.key("near", near, deck::any(), "1/time",
              "growth rate; if given, the Spectrum/number eigenmodes with the growth rates nearest to it are reported instead of the "
              "fastest growing ones");
  section.key("method", method, deck::Choice{"dense", "krylov"},
              "method for the eigenvalues of the Jacobian J of the velocity with respect to the shape. `dense`: all eigenvalues of the "
              "whole matrix, which needs two velocity evaluations per column. `krylov`, for large meshes: the eigenvalues with the growth rates "
              "closest to Spectrum/shift, by block Krylov-Schur with (I - J/shift)^-1; every product is a linear solve by Solvers/spectrum, "
              "preconditioned by an approximate Jacobian. A shape with fewer unknowns than the method keeps vectors has its modes computed as "
              "with `dense`");
  section.key("shift", shift, deck::positive(), "1/time",
              "shift of the shift-and-invert method Spectrum/method `krylov`, which finds the modes with the growth rates closest to this "
              "value first. If not given, the rate of the flow; without flow, the relaxation rate of the membrane, modulus / (viscosity x "
              "R_C), where R_C is the radius of the sphere with the particle's volume");
  section.key("block", block, deck::between(1, 50), "1",
              "number of vectors in a block of Spectrum/method `krylov`. It should be at least the largest number of modes with equal growth "
              "rates, which symmetric shapes have; otherwise some of these modes may be missed");
  section.key(
      "parity", parity, deck::Rule{"1 or -1", [](double sign) { return std::abs(sign) == 1; }}, "1",
      "symmetry of the eigenmodes that are sought: three numbers, for the axes x1, x2, x3. 1: modes symmetric about the plane normal to the axis; "
      "-1: antisymmetric modes, which break the symmetry; all 1 if not given. Give 1 for an axis whose plane is no mirror plane of the steady "
      "shape. If the shape has only a half turn or a point reflection as symmetry, modes that are antisymmetric under it are found with -1 for "
      "one of the axes that it reverses. With Symmetry/use `none`, modes of all symmetries are found at once");
  section.key("difference", difference, deck::between(1e-7, 1e-1), "R_C",
              "step of the finite differences from which the Jacobian of the velocity is computed: largest displacement of a control "
              "point in a perturbed shape, divided by R_C, the radius of the sphere with the particle's volume");
  if (method == "dense") section.without_effect({"shift", "block"}, "with Spectrum/method `dense`");
}

void add_columns(const std::complex<double>& rate, const std::string& number, Columns& to) {
  constexpr const char* fewer = "fewer modes than Spectrum/number are found";
  to.add(rate.real(), {"rate_" + number, "1/time",
                       "growth rate of eigenmode k of the steady shape, k from 1: real part of the eigenvalue. Spectrum/number and "
                       "Spectrum/near determine the order of the modes",
                       fewer});
  to.add(std::abs(rate.imag()), {"frequency_" + number, "1/time",
                                 "angular frequency of eigenmode k of the steady shape, in radians per time: magnitude of the imaginary "
                                 "part of the eigenvalue; 0 if the mode does not oscillate",
                                 fewer});
}

void add_columns(const std::vector<Mode>& modes, int number, bool all_rigid, Columns& to) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double leading = none;
  int unstable = 0;
  for (const Mode& mode : modes)
    if (mode.kind == ModeKind::shape || (all_rigid && mode.kind == ModeKind::rotation))
      leading = std::fmax(leading, mode.rate.real()), unstable += mode.rate.real() > 0;
  to.add(leading, {"leading_rate", "1/time",
                   "largest growth rate of the eigenmodes that change the shape, without translations and rotations of the whole; negative if "
                   "the steady shape is stable. Motions of several particles relative to each other count as changes of the shape. "
                   "Translations and rotations that grow, such as a tilt out of the plane of shear, have a positive rate_k; the summary gives "
                   "the kind of each mode",
                   "none of the reported modes changes the shape"});
  to.add(unstable, {"unstable_modes", "1", "number of growing eigenmodes (positive growth rate) among the reported ones that change the shape"});
  for (std::size_t k = 0; k < static_cast<std::size_t>(number); ++k)
    add_columns(k < modes.size() ? modes[k].rate : std::complex(none, none), std::to_string(k + 1), to);
}

namespace {

/// Computes J y, with J the Jacobian of the velocity v and y the coordinates of a displacement d of x, by a central difference of velocities:
///
///   J y = (v(x + e d) - v(x - e d))/2e,   e max |d| = difference x R_C                                                   (4.16)
///
/// Modes are changes of the shape, not motions of the control points along the surface. On a steady shape the velocity v is a sum of relabellings
/// (Dynamics::relabellings); these are subtracted from v. Displacements and results are projected so that they do not change the conserved
/// quantities: the volumes of the particles and the masses of surfactants. Without the projection, two modes of rate 0 would have the same shape at a
/// fold, and an error of J would change their rates by the square root of the error.
class Linearised {
 public:
  Linearised(const SmallChanges& changes, double difference)
      : changes_(changes), difference_(difference / changes.dynamics.norm(moved(changes.x, coupling::unit_motion(1)))),
        kept_(changes.shapes.size(), static_cast<Eigen::Index>(changes.kept.size())) {
    const auto& [dynamics, shapes, x, kept] = changes;
    Eigen::Index n = 0;
    for (const Conserved& one : kept) {
      const State& gradient = one.gradient;
      Eigen::VectorXd by_y(shapes.size());
      for (Eigen::Index k = 0; k < by_y.size(); ++k) by_y[k] = dot(gradient, shapes.displacement(Eigen::VectorXd::Unit(by_y.size(), k)));
      by_y -= kept_.leftCols(n) * (kept_.leftCols(n).transpose() * by_y);
      // skips the quantity if modes of this parity do not change it, or if it is a mirror image of an earlier one
      if (by_y.norm() > 1e-6 * gradient.norm()) kept_.col(n++) = by_y.normalized();
    }
    kept_.conservativeResize(Eigen::NoChange, n);
    const std::vector<State> fields = dynamics.relabellings(x);
    if (fields.empty()) return;
    Eigen::MatrixXd all(x.numbers().size(), static_cast<Eigen::Index>(fields.size()));
    for (Eigen::Index k = 0; k < all.cols(); ++k) all.col(k) = fields[static_cast<std::size_t>(k)].numbers();
    relabelling_ = all.colPivHouseholderQr().solve(dynamics.velocity(x).numbers());
  }

  /// Returns J y. Throws RunFailure if a velocity cannot be evaluated.
  Eigen::VectorXd operator()(const Eigen::VectorXd& y) const {
    const State d = changes_.shapes.displacement(keeping(y));
    if (d.norm() == 0) return Eigen::VectorXd::Zero(y.size());
    const State change = central_difference([this](const State& x) { return velocity(x); }, changes_.x, d, difference_);
    if (!change.allFinite()) throw RunFailure("the evaluation of the velocity failed for a shape close to the steady shape");
    return keeping(changes_.shapes.coordinates(change));
  }

 private:
  State velocity(const State& x) const {
    State v = changes_.dynamics.velocity(x);
    if (relabelling_.size() == 0 || !v.allFinite()) return v;
    const std::vector<State> fields = changes_.dynamics.relabellings(x);
    for (std::size_t k = 0; k < fields.size(); ++k) v -= relabelling_[static_cast<Eigen::Index>(k)] * fields[k];
    return v;
  }
  Eigen::VectorXd keeping(const Eigen::VectorXd& y) const { return y - kept_ * (kept_.transpose() * y); }

  SmallChanges changes_;
  double difference_;            // length of the largest displacement
  Eigen::VectorXd relabelling_;  // coefficients of v(x) with respect to the fields Dynamics::relabellings, which move points along the surface
  Eigen::MatrixXd kept_;         // orthonormal gradients of the conserved quantities with respect to the coordinates y, one per column
};

/// Returns an orthonormal basis, in shape coordinates, of the given fields that have the symmetry of the shape coordinates. Fields that do not change
/// the shape are left out: rotations of a sphere, and motions of points along the interface of a drop (relabellings).
Eigen::MatrixXd orthonormal(const coupling::ShapeCoordinates& shapes, const std::vector<State>& fields) {
  constexpr double seen = 1e-3;
  Eigen::MatrixXd all(shapes.size(), static_cast<Eigen::Index>(fields.size()));
  Eigen::Index rank = 0;
  for (const State& field : fields) {
    if (!shapes.admits(field)) continue;
    Eigen::VectorXd y = shapes.coordinates(field);
    const double size = y.norm();
    y -= all.leftCols(rank) * (all.leftCols(rank).transpose() * y);
    if (y.norm() > seen * field.norm() && y.norm() > seen * size) all.col(rank++) = y.normalized();
  }
  return all.leftCols(rank);
}

/// Returns an orthonormal basis, in shape coordinates, of the translations (first = 0) or rotations (first = 3) of x.
Eigen::MatrixXd rigid_motions(const coupling::ShapeCoordinates& shapes, const State& x, int first) {
  const Net net = shapes.motion().shape(x);
  const Vec3 centre = net.colwise().mean().transpose();
  std::vector<State> fields;
  for (int k = first; k < first + 3; ++k) fields.push_back(shapes.motion().state_of(coupling::rigid_velocity(net, coupling::unit_motion(k), centre)));
  return orthonormal(shapes, fields);
}

/// Detects modes that do not change the shape: translations, rotations, and relabellings (motions of points along the surface).
class Recognition {
 public:
  explicit Recognition(const SmallChanges& changes)
      : translations_(rigid_motions(changes.shapes, changes.x, 0)),
        rotations_(rigid_motions(changes.shapes, changes.x, 3)),
        labels_(orthonormal(changes.shapes, changes.dynamics.relabellings(changes.x))) {}

  /// Returns the kind of a mode from its components along translations, rotations and relabellings. Modes due to a conserved volume or mass are not
  /// detected here.
  ModeKind kind(const Eigen::VectorXcd& mode) const {
    constexpr double most = 0.9;
    const double translation = (translations_.transpose() * mode).norm(), rotation = (rotations_.transpose() * mode).norm();
    if (std::hypot(translation, rotation) < most * mode.norm())
      return (labels_.transpose() * mode).norm() < most * mode.norm() ? ModeKind::shape : ModeKind::labels;
    return translation > rotation ? ModeKind::translation : ModeKind::rotation;
  }

 private:
  Eigen::MatrixXd translations_, rotations_, labels_;
};

/// Returns the relative change b.d/(|b| |d|) of a conserved quantity with the gradient b = `kept` due to a mode d. The change is zero for all modes
/// of nonzero rate, because conservation implies rate x b.d = 0.
double gain(const State& kept, const Mode& mode) {
  return std::hypot(dot(kept, mode.real), dot(kept, mode.imaginary)) / (kept.norm() * std::hypot(mode.real.norm(), mode.imaginary.norm()));
}

/// Returns the eigenvector as a field on the surface, with the phase that makes it as real as possible, scaled to a maximum of 1.
Mode mode(const coupling::ShapeCoordinates& shapes, const Recognition& recognition, std::complex<double> rate, Eigen::VectorXcd y) {
  const std::complex<double> square = (y.array() * y.array()).sum();
  if (std::abs(square) > 0) y /= std::sqrt(square / std::abs(square));
  Mode found{rate, shapes.displacement(y.real()), shapes.displacement(y.imag()), recognition.kind(y)};
  const auto largest_of = [&](const auto& part) { return std::sqrt((part(found.real) + part(found.imaginary)).maxCoeff()); };
  const double displaced = largest_of([&](const State& x) -> Eigen::VectorXd { return shapes.motion().shape(x).rowwise().squaredNorm(); });
  const double any = largest_of([](const State& x) -> Eigen::VectorXd { return x.numbers().cwiseAbs2(); });
  const double largest = displaced > 1e-6 * any ? displaced : any;
  found.real = found.real / largest, found.imaginary = found.imaginary / largest;
  return found;
}

using Pairs = std::vector<coupling::Eigenpair>;

/// Assembles the Jacobian J of the velocity in shape coordinates, column by column, and computes all its eigenpairs.
Pairs dense(const SmallChanges& changes, const SpectrumOptions& options) {
  const Eigen::Index n = changes.shapes.size();
  Eigen::MatrixXd jacobian(n, n);
  const Linearised linearised(changes, options.difference);
  for (Eigen::Index k = 0; k < n; ++k) jacobian.col(k) = linearised(Eigen::VectorXd::Unit(n, k));
  const std::vector<double> first = coupling::decided([&] { return std::vector(jacobian.data(), jacobian.data() + jacobian.size()); });
  return coupling::eigenpairs(Eigen::Map<const Eigen::MatrixXd>(first.data(), n, n));
}

/// Computes the eigenpairs of the Jacobian J with the largest |1/(1 - rate/shift)| by shift-and-invert. Applies (I - J/shift)^-1 by GMRES with the
/// preconditioner of an implicit step.
Pairs shifted(const SmallChanges& changes, const SpectrumOptions& options, const coupling::IterativeOptions& solver) {
  constexpr double tolerance = 1e-6;
  const double step = 1 / options.shift.value();
  const Linearised linearised(changes, options.difference);
  changes.dynamics.freeze(changes.x);
  changes.dynamics.linearise(changes.x);
  const Eigen::Index n = changes.shapes.size();
  using Numbers = Eigen::Map<const Eigen::VectorXd>;
  const coupling::Krylov krylov(solver);
  const coupling::LinearSystem system{
      coupling::one_block("shape", n),
      [&](const double* in, double* out) {
        const Eigen::VectorXd y = Numbers(in, n);
        Eigen::Map<Eigen::VectorXd>(out, n) = y - step * linearised(y);
      },
      [&](const double* in, double* out) {
        const State r = changes.shapes.displacement(Numbers(in, n));
        Eigen::Map<Eigen::VectorXd>(out, n) = changes.shapes.coordinates(changes.dynamics.solve(step, r, 1e-2, {}));
      }};
  const auto inverse = [&](const double* in, double* out) {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(n);
    coupling::require_convergence(krylov.solve(system, Numbers(in, n), y, 0.1 * tolerance), "the shift-inverted motion", tolerance);
    Eigen::Map<Eigen::VectorXd>(out, n) = y;
  };
  Pairs pairs = coupling::largest_eigenpairs(inverse, n, options.number, options.block, tolerance);
  for (coupling::Eigenpair& pair : pairs) pair.value = (1. - 1. / pair.value) / step;
  return pairs;
}

}  // namespace

std::vector<Mode> spectrum(const SmallChanges& changes, const SpectrumOptions& options, const coupling::IterativeOptions& solver) {
  const bool whole = options.method == "dense" || changes.shapes.size() <= coupling::krylov_vectors(options.number, options.block);
  Pairs pairs = whole ? dense(changes, options) : shifted(changes, options, solver);
  const auto rank = [&](const coupling::Eigenpair& pair) { return options.near ? std::abs(pair.value - *options.near) : -pair.value.real(); };
  std::ranges::stable_sort(pairs, {}, rank);
  pairs.resize(std::min<std::size_t>(pairs.size(), static_cast<std::size_t>(options.number)));
  return recognised(changes, pairs);
}

std::vector<Mode> recognised(const SmallChanges& changes, const std::vector<coupling::Eigenpair>& pairs) {
  const Recognition recognition(changes);
  std::vector<Mode> modes;
  for (const coupling::Eigenpair& pair : pairs) modes.push_back(mode(changes.shapes, recognition, pair.value, pair.vector));
  std::vector<bool> told(modes.size(), false);
  for (const auto& [gradient, kind] : changes.kept) {
    std::vector<double> gains;
    for (std::size_t i = 0; i < modes.size(); ++i) gains.push_back(told[i] ? 0 : gain(gradient, modes[i]));
    const auto most = std::ranges::max_element(gains);
    if (most == gains.end() || *most <= 1e-3) continue;
    const std::size_t i = static_cast<std::size_t>(most - gains.begin());
    // This mode changes the conserved quantity most. Its shape does not identify it, because near a fold another mode has nearly this shape.
    modes[i].kind = kind, told[i] = true;
  }
  return modes;
}

}  // namespace tanktread::motion
