#pragma once
// Operators that depend only on the wall of a tube, constructed once per wall.

#include <array>
#include <cassert>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "stokes/flow/cap.hpp"
#include "stokes/layer.hpp"
#include "surface/closest_points.hpp"
#include "surface/symmetry.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/solids/ducts/wall_factors.hpp"
#include "system/solids/ducts/wall_patches.hpp"
#include "system/solids/ducts/wall_points.hpp"
#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// Solver options of the linear system for the traction on a wall.
struct WallSolver {
  std::string method = "factored";  ///< "factored" (LU factors), "iterative", or "auto": iterative if the factors take more than most_bytes
  double tolerance = 1e-8;          ///< relative residual of the iterative solver

  static constexpr double most_bytes = 4e9;

  bool operator==(const WallSolver&) const = default;

  /// Return whether the linear system is solved iteratively: may_iterate(), for some size of the system; iterates(), if its LU factors take `bytes`.
  /// The operator of a periodic wall is always factored.
  bool may_iterate(bool periodic) const { return !periodic && method != "factored"; }
  bool iterates(double bytes, bool periodic) const { return may_iterate(periodic) && (method == "iterative" || bytes > most_bytes); }
};

struct EmptyChannel;
struct PointsOff;

/// The single layer of the wall on itself, assembled and factored, and the inlet integral (2.13). The viscosity is not included. Nets are in the
/// wall's frame. The ranks share the assembly, but each rank stores all factors: 72 bytes per pair of control points, divided by the number of
/// reflections that map the wall to itself (WallFactors).
///
/// If a symmetry is given, all fields must have it. Only the parities are then factored that fields with this symmetry can have.
///
/// If the factors would be too large and the wall is open, each system is solved by GMRES, with products by a treecode (TreeSum). The preconditioner
/// combines WallPatches and data recycled from earlier solves (2.24).
///
/// A periodic wall is represented by one period, with the kernels of one period and no ends. Tractions f are periodic, with one row of control values
/// per site. A traction q n of constant pressure q produces no velocity. Therefore the condition int f.n dGamma = 0 is added to A.
class Wall {
 public:
  /// Assembles and factors the operator. Collective. `phases`: if given, records the time of communication between ranks, also in `apply`; must
  /// outlive this object.
  Wall(const surface::TubeWall& wall, const quadrature::Options& quadrature, Phases* phases = nullptr,
       const surface::Symmetry& symmetry = surface::Symmetry(), const WallSolver& solver = {});

  bool iterates() const { return patches_of_rows_.has_value(); }

  /// Returns whether the constructor would construct the same operator from these arguments.
  bool is_for(const surface::TubeWall& wall, const quadrature::Options& quadrature, const surface::Symmetry& symmetry,
              const WallSolver& solver) const;

  const surface::TubeWall& surface() const { return surface_; }
  const surface::Symmetry& symmetry() const { return symmetry_; }
  const WallPoints& points() const { return points_; }  ///< collocation points, and the points at which the velocity is evaluated
  stokes::Layer& layer() { return layer_; }             ///< single layer at points off the wall, for control values on the layer's space
  const quadrature::Options& quadrature() const { return quadrature_; }

  /// Computes the rows `points.own` of u, the velocity G_W f at points off the wall. Not collective.
  void velocity(const Net& f, const PointsOff& points, Net& u);

  /// Returns the first of the points `rows` of x that is not inside the duct or, in a channel, not between its ends; -1 if there is none.
  Eigen::Index first_outside(const Net& x, std::span<const int> rows) const;
  const stokes::Cap& inlet() const { return assert(inlet_), *inlet_; }  ///< inlet of an open wall; not available for a periodic wall

  /// Returns the lattice of a periodic wall; not set for an open wall.
  const std::optional<stokes::PeriodicCell>& cell() const { return cell_; }

  /// Returns the lowest and highest coordinates of the wall in the axes of the cell.
  std::array<Vec3, 2> range() const { return cell_->range(surface_.net); }

  /// Converts the control values of a traction f, one row per collocation site of the wall, to control values on the space of layer(). Changes f only
  /// if the wall is periodic, because f is then a periodic spline, whereas this space is not periodic. from_space() multiplies by the transpose of
  /// this map.
  Net on_space(const Net& f) const { return cell_ ? Net(surface_.open_from_periodic * f) : f; }
  Net from_space(const Net& weights) const { return cell_ ? Net(surface_.open_from_periodic.transpose() * weights) : weights; }
  template <class Real>
  void from_space(stokes::Rows<Real>& rows) const;  ///< multiplies a matrix for control values on the space of layer() by on_space()

  /// Returns A f = points().collocated(u), where u is the velocity of the single layer at the targets x_i:
  /// u_i = (1 / 8 pi) sum_B int G(x, x_i) N_B dGamma f_B. In a periodic wall, A includes the condition int f.n dGamma = 0.
  Net apply(const Net& f) const;
  Net solve(const Net& rhs) const;  ///< returns A^-1 rhs

  /// Returns w = A^-T `weights`. For any right-hand side rhs, the inner product of w and rhs equals the inner product of `weights` and solve(rhs).
  /// Available only if the operator is factored.
  Net solve_transposed(const Net& weights) const;

  const Net& inlet_column() const { return inlet_column_; }  ///< right-hand side for the inlet integral c (2.13); 0 for a periodic wall
  /// Returns the wall traction A^-1 c (2.13) in the open, empty tube per unit pressure drop; 0 for a periodic wall.
  const Net& traction_per_pressure_drop() const { return traction_per_pressure_drop_; }

  /// Returns the flow of the empty channel, which all systems that share this wall use. `make`: makes it at the first call.
  EmptyChannel& empty_channel(const std::function<EmptyChannel*()>& make);

  /// Returns the bounding boxes of the elements of the wall, used to compute distances from it. They are computed at the first call.
  const surface::ElementBoxes& boxes();

  stokes::Evaluations evaluations() const;  ///< number of kernel evaluations, including those of empty_channel()

 private:
  Eigen::Index n_sites() const { return points_.sites().rows(); }
  void assemble_rows(std::span<const int> targets, stokes::Rows<double>& rows);
  void factor(const surface::Symmetry& of_wall);
  Net iterated(const Net& rhs) const;
  void find_null_vector();

  surface::TubeWall surface_;
  surface::Symmetry symmetry_;
  quadrature::Options quadrature_;
  WallSolver solver_;
  double inner_radius_;  // radius of the largest circle about the centroid that fits in the cross-section at the start
  std::optional<surface::Patches> patches_;
  std::optional<surface::ElementBoxes> boxes_;
  WallPoints points_;
  std::optional<stokes::PeriodicCell> cell_;
  stokes::Layer layer_;
  std::optional<stokes::Cap> inlet_;
  Net inlet_column_, traction_per_pressure_drop_;
  struct NoFlux {     // condition int f.n dGamma = 0 of a periodic wall
    Net null_vector;  // normals n at the sites, scaled by radius/(flux_vector.n); a traction proportional to n produces no velocity
    Net flux_vector;  // int N_A n dGamma
  } no_flux_;
  std::unique_ptr<stokes::Layer> on_itself_;  // single layer of the wall at the targets on the wall itself
  WallFactors factors_;                       // LU factors of A; if not set, patches_of_rows_ and krylov_ solve by iteration
  std::optional<WallPatches> patches_of_rows_;
  std::unique_ptr<Krylov> krylov_;
  std::shared_ptr<EmptyChannel> empty_channel_;
};

}  // namespace tanktread::coupling
