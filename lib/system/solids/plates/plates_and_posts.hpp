#pragma once
// Solids with a prescribed velocity that repeat on a lattice: plates and posts.

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/dense_factors.hpp"
#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "stokes/layer.hpp"
#include "surface/walls/solid_surface.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solids/plates/plate_factors.hpp"
#include "system/targets/points_off.hpp"

namespace tanktread::coupling {

/// Single layer of solids on a lattice, assembled and factored once. f is the force per area that the solids exert on the fluid. F is the given total
/// force of the solids of one cell on the fluid. U is a uniform velocity:
///
///   (1/mu) G_S f + U = u on the solids,   e.int f dGamma = e.F for every free direction e of U,   int_s f.n dGamma = 0 for every solid s     (2.46)
///
/// The last condition makes f unique, because f = n on one solid produces no velocity. U is a combination of the free directions e. With three
/// periods, all directions are free because the mean velocity follows from the pressure gradient. At a single plate with unbounded fluid on its other
/// side, directions along the plate are free. In these cases, the balance of forces determines U. Otherwise there is no free direction, and U = 0.
///
/// f is a periodic spline, with one control value per collocation point. If all solids are plates, the operator is inverted by Fourier series
/// (PlateFactors). Otherwise the matrix is dense. Nets are replicated on all ranks. All calls except queries are collective.
class PlatesAndPosts {
 public:
  /// A connected part of the solids, for example one plate. The density equal to the unit normal n on this part and 0 on all other parts is a null
  /// vector of the single layer. `velocity`: prescribed velocity of this part, tangential to its surface.
  struct Solid {
    surface::SolidSurface surface;
    Vec3 velocity = Vec3::Zero();
    std::function<bool(const Vec3& x)> outside;  ///< returns whether x is in front of a plate, or outside of a post and its images; empty: always
    std::string name;                            ///< name of the part, for messages
  };

  struct Parameters {
    stokes::PeriodicCell cell;  ///< lattice on which the solids repeat
    std::vector<Vec3> free;     ///< unit vectors e along which the uniform velocity U of (2.46) is an unknown
    double viscosity;           ///< viscosity mu of the fluid
    quadrature::Options quadrature;

    bool operator==(const Parameters&) const = default;
  };

  /// `solids` need not outlive this object.
  PlatesAndPosts(const std::vector<Solid>& solids, const Parameters& parameters, Phases& phases);

  /// Returns whether the constructor would construct the same operator from these arguments.
  bool is_for(const std::vector<Solid>& solids, const Parameters& parameters) const;

  /// Solution of (2.46): the force density f and the uniform velocity U.
  struct Flow {
    Net force;  ///< control values of f
    Vec3 drift = Vec3::Zero();

    Flow operator+(const Flow& other) const { return {force + other.force, drift + other.drift}; }
  };

  /// Sets the range of heights above a plate in which `velocity_at` is accurate, so that the range contains the solids and the points x. Must be
  /// called before `prepared` and `velocity_at`, again after another system that shares this object has called it. x must be equal on all ranks.
  void reach(const Net& x);

  /// Point of a particle that is in a solid: its row, -1 if there is no such point, and the name of the solid.
  struct Crossing {
    Eigen::Index site = -1;
    std::string solid;
  };

  /// Returns the first of the points `at` that is not outside of a solid (Solid::outside).
  Crossing crossing(const Net& at) const;

  /// Returns the solution f, U of (2.46) for given right-hand sides: the velocity u at the collocation points, and the force F.
  Flow solve(const Net& u, const Vec3& force) const;

  /// Returns the points `at` off the solids, prepared so that several solutions cost less. `own`: rows to evaluate. Not collective.
  PointsOff prepared(Net at, std::vector<int> own);

  /// Computes the rows `points.own` of u, the velocity at these points due to the solution `flow`. Not collective.
  void velocity_at(const PointsOff& points, const Flow& flow, Net& u);

  std::vector<Vec3> forces(const Net& f) const;  ///< returns the integral of the force density f over each solid

  /// Returns the power int f.V dGamma of a force density f, with the prescribed velocities V of the solids.
  double power(const Net& f) const { return f.cwiseProduct(areas_.asDiagonal() * velocities_).sum(); }

  /// Returns int N_A phi dGamma for every control point A, where phi is the given function. The inner product with a force density f is
  /// int phi f dGamma.
  Eigen::VectorXd moments(const std::function<double(const Vec3& x)>& function) const;

  const Net& sites() const { return sites_; }            ///< collocation points
  const std::vector<int>& own() const { return own_; }   ///< rank-owned collocation points
  const Net& velocities() const { return velocities_; }  ///< prescribed velocity at the collocation points
  const stokes::PeriodicCell& cell() const { return parameters_.cell; }
  double viscosity() const { return parameters_.viscosity; }
  const Ranks& ranks() const { return ranks_; }
  Net on_space(const Net& f) const { return surface_.open_from_periodic * f; }  ///< control values of f on the layer's space, which is not periodic
  const surface::SolidSurface& surface() const { return surface_; }
  const std::array<Vec3, 2>& range() const { return range_; }  ///< lowest and highest coordinates of the solids, in the axes of the cell
  stokes::Evaluations evaluations() const { return evaluations_ + layer_->evaluations(); }

 private:
  void factor_plates(stokes::Layer& on_itself, const std::array<int, 2>& grid);
  void factor(stokes::Layer& on_itself);
  Eigen::MatrixXd rows(stokes::Layer& on_itself, std::span<const int> sites) const;
  double area(std::size_t s) const { return areas_.segment(first_[s], first_[s + 1] - first_[s]).sum(); }  // area of solid s
  void make_layer();
  bool reaches(const Net& at) const;  // whether `velocity_at` is accurate at these points

  surface::SolidSurface surface_;
  Parameters parameters_;
  Ranks ranks_;
  std::vector<int> own_;
  std::array<Vec3, 2> range_;            // lowest and highest coordinates of the solids, in the axes of the cell
  std::array<Vec3, 2> reached_;           // lowest and highest coordinates, in the axes of the cell, for which `layer_` is set up
  std::unique_ptr<stokes::Layer> layer_;  // single layer at points off the solids
  Net sites_, velocities_;
  Eigen::VectorXd areas_;   // int N_A dGamma
  std::vector<int> first_;  // index of the first collocation point of each solid; last entry: number of all collocation points
  Net normals_;                        // unit normals at the collocation points
  Net flux_;                           // int N_A n dGamma
  std::vector<std::pair<std::function<bool(const Vec3& x)>, std::string>> outside_;  // Solid::outside and name of all solids that have it
  std::optional<PlateFactors> plates_;  // inverse of the operator by Fourier series; set if all solids are plates
  DenseFactors factors_;                // LU factors of the operator; if all solids are plates, only of its block for densities that are uniform on
                                        // each plate
  stokes::Evaluations evaluations_;     // kernel evaluations of the assembly and of the layers that reach() has replaced, without the evaluations
                                        // of the current `layer_`
};

}  // namespace tanktread::coupling
