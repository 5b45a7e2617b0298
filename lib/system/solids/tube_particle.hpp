#pragma once
// Data of the particle in a tube, which change with its shape.

#include <array>
#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/direct_solver.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "system/collocation.hpp"
#include "system/solids/tube.hpp"
#include "system/solids/wall.hpp"
#include "system/solvers/frozen_operator.hpp"

namespace tanktread::coupling {

struct Tube::Particle {
  /// Data of a periodic duct.
  struct Period {
    stokes::PeriodicCell cell;
    std::array<Vec3, 2> across;  ///< lowest and highest coordinates of the wall, in the axes of the cell
    Net targets;                 ///< targets of the wall, then the collocation points of the particle
    std::vector<int> own;        ///< rank-owned rows of `targets`
  };

  Particle(const spline::Space& space, const TubeParameters& parameters, const Wall& wall);

  void set_contrasts(const Eigen::VectorXd& of_points);
  /// Sets the shape. `origin`: position along x1 of the origin of the wall's frame. `pressure_drop`: pressure drop of the empty duct.
  void place(const Net& x, double origin, const stokes::DuctFlow& flow, Wall& wall, double pressure_drop);

  /// Stores the operators of the current shape as low-precision blocks. `pressure_of_wall`: weights with which a velocity on the wall contributes to
  /// the pressure drop dp, or empty. If it is not empty, also computes the weights with which the particle's velocity v contributes to dp: the
  /// product of `pressure_of_wall` and the double layer. For accuracy, the rows of the double layer are rounded only afterwards.
  void freeze(Wall& wall, const Net& pressure_of_wall);

  const stokes::Layer::Near* kept(const std::optional<stokes::Layer::Near>& near) const { return near ? &*near : nullptr; }

  /// Returns, for each target on the wall, the value of v at the nearest collocation point of the particle.
  Net nearest_values(const Net& v) const;

  /// Returns (1 - lambda) v: the strength of the double layer.
  Net strength(const Net& v) const { return contrasts.asDiagonal() * v; }

  /// Adds to rows of u the velocity at the points `at` (in the wall's frame) due to the images of the particle in a periodic duct, for the load f and
  /// the velocity v. An empty net counts as zero.
  void add_images(const Net& f, const Net& v, const Net& at, std::span<const int> rows, Net& u);

  /// Velocities that the load f and the velocity v of the particle cause in a periodic duct, for rank-owned rows. `at_wall`: at the targets on the
  /// wall, due to the particle and its images. `at_sites`: at the particle's collocation points, due to its images only. An empty net counts as zero.
  struct Cause {
    Net at_wall, at_sites;
  };
  Cause cause(const Net& f, const Net& v, const Wall& wall);

  /// Returns the weights w of the double-layer strength q = (1 - lambda) v: the double layer causes the flow rate w.q along the duct. Cached for the
  /// current shape.
  const Net& flow_of_strength(const Wall& wall);

  stokes::Evaluations evaluations() const;

  const spline::Space& space;
  TubeParameters parameters;
  stokes::Measure measure = stokes::Measure::reference;  // area to which loads refer
  std::vector<int> own;                                  ///< rank-owned points
  Ranks ranks;
  surface::Geometry geometry;
  Eigen::SparseMatrix<double> collocation;  ///< collocation matrix R
  membrane::DirectSolver from_sites;        ///< factored collocation matrix R, to compute control values from values at the sites
  stokes::Layer single;
  std::optional<stokes::Layer> dual;  ///< double layer; set if at least one contrast is not 0
  std::optional<Period> period;       ///< set if the duct is periodic
  Eigen::VectorXd contrasts;          ///< contrast of each control point, see Tube::set_contrasts

  Net shape;                                   ///< net of the particle in the frame of the wall
  double centroid = 0;                         ///< x1 of the origin of the wall's frame, which is the particle's centroid in a straight open tube
  Net sites;                                   ///< collocation points, in the wall's frame
  Net inlet;                                   ///< velocity c (2.5) per unit pressure drop, at the sites
  Net ambient, interpolated_ambient;           ///< ambient: duct flow v_inf at the sites. interpolated_ambient: control values of v_inf (in a channel
                                               ///< only)
  Net pressure_of_load, pressure_of_velocity;  ///< weights of the load f and of the velocity v in the pressure drop (2.7); pressure_of_velocity is
                                               ///< empty if lambda = 1
  std::vector<int> nearest;                    ///< index of the particle's nearest site for each target on the wall
  std::optional<stokes::Layer::Near> dual_on_wall, wall_on_sites;  ///< near-field corrections, cached for the iterations if lambda != 1.
                                                                   ///< dual_on_wall: corrections of the particle's double layer at the wall.
                                                                   ///< wall_on_sites: corrections of the wall's layer at the particle's sites

  struct Frozen {
    FrozenOperator single, dual, wall;
    Net inlet, ambient, pressure_of_load, pressure_of_velocity;
  };
  Frozen frozen;

 private:
  void weigh_pressure(const stokes::DuctFlow& flow, bool straight);
  Net ambient_of(const stokes::DuctFlow& flow) const;

  Net flow_of_strength_;
};

/// Points of the wall between its collocation points, at which leak() evaluates the velocity, and the single layer for these points.
struct Tube::BetweenSitesOfWall {
  BetweenSitesOfWall(const surface::TubeWall& wall, const std::optional<stokes::PeriodicCell>& cell, const BetweenSites& between,
                     const quadrature::Options& options);

  Net at;                               ///< positions
  Eigen::SparseMatrix<double> weights;  ///< see BetweenSites
  stokes::Layer layer;                  ///< single layer of the wall at the points
};

}  // namespace tanktread::coupling
