#pragma once
// The linearised motion about a shape: growth rates and modes of small changes of shape.

#include <algorithm>
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

using coupling::State;

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
inline const std::vector<std::string> mode_kinds{"shape", "translation", "rotation", "labels", "volume", "mass"};  ///< words for ModeKind
inline const std::string& name(ModeKind kind) { return mode_kinds.at(static_cast<std::size_t>(kind)); }

/// Gradient, with respect to the state, of a quantity that the motion conserves. `kind`: kind of the mode of rate 0 that the conservation causes.
struct Conserved {
  State gradient;
  ModeKind kind;
};

/// Data that define the linearised motion of small changes of the shape x. The referenced objects must outlive this object.
struct SmallChanges {
  coupling::Dynamics& dynamics;              ///< motion of the shape
  const coupling::ShapeCoordinates& shapes;  ///< coordinates y of the changes
  const State& x;
  const std::vector<Conserved>& kept;        ///< conserved quantities; their gradients identify the modes that have rate 0 due to conservation
};

/// Eigenmode Re(mode e^{rate t}) of the linearised motion: a displacement of the control points and, if there are surface fields, a change of the
/// fields. It is scaled such that the largest displacement is 1. If no control point moves, the largest component is 1.
struct Mode {
  std::complex<double> rate;
  State real, imaginary;
  ModeKind kind = ModeKind::shape;
};

/// Adds the columns of one eigenmode. `number`: number of the mode, from 1.
void add_columns(const std::complex<double>& rate, const std::string& number, Columns& to);

/// Adds the columns of a spectrum of `number` modes, numbered from 1. If there are fewer modes, the values of the others are NaN. `all_rigid`: no
/// particle deforms, so the modes are rotations.
void add_columns(const std::vector<Mode>& modes, int number, bool all_rigid, Columns& to);

/// Returns the derivative of the function f of a state along the change d of x, by a central difference. `largest`: length of the largest
/// displacement of a control point, or largest change of a number of a field:
///
///   (f(x + e d) - f(x - e d))/2e,   e max |d| = largest
template <class Function>
State central_difference(Function&& f, const State& x, const State& d, double largest) {
  double most = 0;
  for (std::size_t k = 0; k < d.layout()->blocks().size(); ++k) most = std::max(most, d(coupling::BlockId{k}).rowwise().norm().maxCoeff());
  const double e = largest / most;
  return (f(x + e * d) - f(x - e * d)) / (2 * e);
}

/// Converts eigenpairs in shape coordinates to fields on the surface, and determines the kind of each mode. Collective.
std::vector<Mode> recognised(const SmallChanges& changes, const std::vector<coupling::Eigenpair>& pairs);

/// Returns the leading modes that `options` ask for; `options.shift` must be set for krylov. `solver`: options for the shift-and-invert systems.
/// Collective. Throws RunFailure if a velocity or the eigenvalues cannot be computed.
std::vector<Mode> spectrum(const SmallChanges& changes, const SpectrumOptions& options, const coupling::IterativeOptions& solver);

}  // namespace tanktread::motion
