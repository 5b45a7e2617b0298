#pragma once
// The linearised motion about a shape: how fast small changes of shape grow or decay, and which.

#include <complex>
#include <functional>
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

/// `Spectrum/*` of the deck.
struct SpectrumOptions {
  bool present = false;            ///< whether the deck has this list
  int number = 12;                 ///< of modes that are reported
  std::optional<double> near;      ///< those whose rate is nearest to this one, 1/time; empty: those that grow fastest
  std::string method = "dense";    ///< dense, krylov
  std::optional<double> shift;     ///< of krylov, 1/time
  int block = 3;                   ///< of krylov
  std::optional<Vec3> parity;      ///< of the modes under mirror planes across x1, x2, x3; empty: that of the shape
  double difference = 1e-5;        ///< size of the displacements whose velocities the Jacobian is made of, over R_C

  void declare(deck::Section& section);
};

/// What a mode is beside a change of shape.
enum class ModeKind { shape, translation, rotation, labels, volume, mass };
const char* name(ModeKind kind);

/// A displacement, or a change of a state with fields, that grows like Re(mode e^{rate t}), its largest displacement 1; where nothing moves, its
/// largest number.
struct Mode {
  std::complex<double> rate;
  Net real, imaginary;
  ModeKind kind = ModeKind::shape;

  void add_columns(const std::string& number, Columns& to) const;
};

/// Adds the columns of a spectrum, and of its modes from 1. `all_rigid`: no particle deforms, and rotations are what changes.
void add_columns(const std::vector<Mode>& modes, bool all_rigid, Columns& to);

/// J y for the coordinates y of a displacement of x, by a central difference of velocities:
///
///   J y = (v(x + e d) - v(x - e d))/2e,   e |d| = difference x R_C at the largest                                        (4.16)
///
/// v without the relabellings (Dynamics::relabellings) that it consists of at a shape at rest: modes are changes of shape as seen from outside.
/// Before and after, what a displacement gains of what the motion keeps, the volume and the masses of surfactants, is taken away. At a fold two modes
/// of rate 0 would else have one shape, and errors of J would move their rates by their square roots.
class Linearised {
 public:
  /// About x, where `kept` are the gradients of what the motion keeps; the motion outlives it, as all else here. Collective.
  Linearised(coupling::Dynamics& dynamics, const coupling::ShapeCoordinates& shapes, const Net& x, const std::vector<Net>& kept, double difference);

  /// J y. Throws RunFailure where a velocity cannot be had. Collective.
  Eigen::VectorXd operator()(const Eigen::VectorXd& y) const;

 private:
  Net velocity(const Net& x) const;
  Eigen::VectorXd keeping(const Eigen::VectorXd& y) const { return y - kept_ * (kept_.transpose() * y); }

  coupling::Dynamics& dynamics_;
  const coupling::ShapeCoordinates& shapes_;
  const Net& x_;
  double difference_;            // a length
  Eigen::VectorXd relabelling_;  // parts of v(x)
  Eigen::MatrixXd kept_;         // orthonormal gradients by y, a column each
};

/// Eigenpairs in coordinates of shapes as fields on the surface, what is no change of shape recognised. `kept`: the gradients of what the motion
/// keeps, first of the volume, which tell the modes that have the rate 0 only for that. Collective.
std::vector<Mode> recognised(coupling::Dynamics& dynamics, const coupling::ShapeCoordinates& shapes, const Net& x, const std::vector<Net>& kept,
                             const std::vector<coupling::Eigenpair>& pairs);

/// The leading modes of the motion about x, as `options` ask, whose shift is given. `solver`: of the shift-inverted systems. Collective. Throws
/// RunFailure where a velocity or the eigenvalues cannot be had.
std::vector<Mode> spectrum(coupling::Dynamics& dynamics, const coupling::ShapeCoordinates& shapes, const Net& x, const std::vector<Net>& kept,
                           const SpectrumOptions& options, const coupling::IterativeOptions& solver);

}  // namespace tanktread::motion
