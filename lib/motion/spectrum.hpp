#pragma once
// The linearised motion about a shape: growth rates and modes of small changes of shape.

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "base/types.hpp"
#include "system/dynamics.hpp"
#include "system/shape_coordinates.hpp"
#include "system/solvers/eigenvalues.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

/// Options of the linear stability analysis, `Spectrum/*` of the deck.
struct SpectrumOptions {
  bool present = false;            ///< true if the deck has the section Spectrum
  int number = 12;                 ///< number of modes to report
  std::optional<double> near;      ///< rate near which modes are reported, 1/time; empty: the fastest-growing modes are reported
  std::string method = "dense";    ///< dense, krylov
  std::optional<double> shift;     ///< shift for krylov, 1/time
  int block = 3;                   ///< block size for krylov
  std::optional<Vec3> parity;      ///< parity of the modes under reflections of x1, x2, x3: 1 symmetric, -1 antisymmetric. If not set, the modes have
                                   ///< the symmetry of the shape
  double difference = 1e-5;        ///< size of the displacements in the finite differences for the Jacobian, divided by the particle radius R_C

  void declare(deck::Section& section);
};

/// Kind of a mode: a change of shape; a neutral mode that translates, rotates or only relabels the surface; or a mode due to a conserved volume or
/// mass.
enum class ModeKind { shape, translation, rotation, labels, volume, mass };
const char* name(ModeKind kind);

/// Gradient, with respect to the state, of a quantity that the motion conserves. `kind`: kind of the mode of rate 0 that the conservation causes.
struct Conserved {
  Net gradient;
  ModeKind kind;
};

/// Eigenmode Re(mode e^{rate t}) of the linearised motion: a displacement of the control points and, if there are surface fields, a change of the
/// fields. It is scaled such that the largest displacement is 1. If no control point moves, the largest component is 1.
struct Mode {
  std::complex<double> rate;
  Net real, imaginary;
  ModeKind kind = ModeKind::shape;
};

/// Adds the columns of one eigenmode. `number`: number of the mode, from 1.
void add_columns(const std::complex<double>& rate, const std::string& number, Columns& to);

/// Adds the columns of a spectrum of `number` modes, numbered from 1. If there are fewer modes, the values of the others are NaN. `all_rigid`: no
/// particle deforms, so the modes are rotations.
void add_columns(const std::vector<Mode>& modes, int number, bool all_rigid, Columns& to);

/// Returns the derivative of the function f of a net along the displacement d of x, by a central difference. `largest`: length of the largest
/// displacement of a control point:
///
///   (f(x + e d) - f(x - e d))/2e,   e max |d| = largest
template <class Function>
Net central_difference(Function&& f, const Net& x, const Net& d, double largest) {
  const double e = largest / d.rowwise().norm().maxCoeff();
  return (f(x + e * d) - f(x - e * d)) / (2 * e);
}

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
  /// Linearises the motion about x. `kept`: conserved quantities. The arguments must outlive this object. Collective.
  Linearised(coupling::Dynamics& dynamics, const coupling::ShapeCoordinates& shapes, const Net& x, const std::vector<Conserved>& kept,
             double difference);

  /// Returns J y. Throws RunFailure if a velocity cannot be evaluated. Collective.
  Eigen::VectorXd operator()(const Eigen::VectorXd& y) const;

 private:
  Net velocity(const Net& x) const;
  Eigen::VectorXd keeping(const Eigen::VectorXd& y) const { return y - kept_ * (kept_.transpose() * y); }

  coupling::Dynamics& dynamics_;
  const coupling::ShapeCoordinates& shapes_;
  const Net& x_;
  double difference_;            // length of the largest displacement
  Eigen::VectorXd relabelling_;  // coefficients of v(x) with respect to the fields Dynamics::relabellings, which move points along the surface
  Eigen::MatrixXd kept_;         // orthonormal gradients of the conserved quantities with respect to the coordinates y, one per column
};

/// Converts eigenpairs in shape coordinates to fields on the surface, and determines the kind of each mode. `kept`: conserved quantities, whose
/// gradients identify the modes that have rate 0 only because of conservation. Collective.
std::vector<Mode> recognised(coupling::Dynamics& dynamics, const coupling::ShapeCoordinates& shapes, const Net& x, const std::vector<Conserved>& kept,
                             const std::vector<coupling::Eigenpair>& pairs);

/// Returns the leading modes of the motion about x that `options` ask for; `options.shift` must be set for krylov. `solver`: options for the
/// shift-and-invert systems. Collective. Throws RunFailure if a velocity or the eigenvalues cannot be computed.
std::vector<Mode> spectrum(coupling::Dynamics& dynamics, const coupling::ShapeCoordinates& shapes, const Net& x, const std::vector<Conserved>& kept,
                           const SpectrumOptions& options, const coupling::IterativeOptions& solver);

}  // namespace tanktread::motion
