#pragma once
// The particle in the tube: what changes with its shape.

#include <array>
#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/direct_solver.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "system/solids/tube.hpp"
#include "system/solids/wall.hpp"
#include "system/solvers/frozen_operator.hpp"

namespace tanktread::coupling {

struct Tube::Particle {
  /// Data of a duct that repeats.
  struct Period {
    stokes::PeriodicCell cell;
    std::array<Vec3, 2> across;  ///< extent of the wall, in the axes of the cell
    Net targets;                 ///< targets of the wall, then the collocation points of the particle
    std::vector<int> own;        ///< rank-owned rows of `targets`
  };

  Particle(const spline::Space& space, const TubeParameters& parameters, const Wall& wall);

  void set_contrasts(const Eigen::VectorXd& of_points);
  /// `origin`: of the wall's frame along x1. `pressure_drop`: of the empty duct.
  void place(const Net& x, double origin, const stokes::DuctFlow& flow, Wall& wall, double pressure_drop);

  /// `pressure_of_wall`: weights of a velocity on the wall in dp, which those of v are made from, for rows of few bits are too coarse; or none.
  void freeze(Wall& wall, const Net& pressure_of_wall);

  const stokes::Layer::Near* kept(const std::optional<stokes::Layer::Near>& near) const { return near ? &*near : nullptr; }

  /// v at the collocation point of the particle that is nearest to each target on the wall.
  Net nearest_values(const Net& v) const;

  /// (1 - lambda) v: the strength of the double layer.
  Net strength(const Net& v) const { return contrasts.asDiagonal() * v; }

  /// Adds to rows of u the velocity at these points, in the wall's frame, that a load f and a velocity v, if there, cause by the images of the
  /// particle in a duct that repeats.
  void add_images(const Net& f, const Net& v, const Net& at, std::span<const int> rows, Net& u);

  /// Velocities that f and v, if there, cause in a duct that repeats: at the wall's targets by the particle and its images, and at the collocation
  /// points by its images. Rows of this rank.
  struct Cause {
    Net at_wall, at_sites;
  };
  Cause cause(const Net& f, const Net& v, const Wall& wall);

  /// Weights of (1 - lambda) v: the flow rate of its double layer along the duct. Kept for the present shape.
  const Net& flow_of_strength(const Wall& wall);

  stokes::Evaluations evaluations() const;

  const spline::Space& space;
  TubeParameters parameters;
  stokes::Measure measure = stokes::Measure::reference;  // of loads
  std::vector<int> own;  ///< points of this rank
  Ranks ranks;
  surface::Geometry geometry;
  Eigen::SparseMatrix<double> collocation;  ///< R
  membrane::DirectSolver from_sites;        ///< R^-1
  stokes::Layer single;
  std::optional<stokes::Layer> dual;  ///< where a lambda is not 1
  std::optional<Period> period;       ///< of a duct that repeats
  Eigen::VectorXd contrasts;               ///< 1 - lambda of each control point

  Net shape;                                                            ///< in the wall's frame
  double centroid = 0;                                                  ///< where that frame has its origin
  Net sites;                                                            ///< collocation points, in the wall's frame
  Net inlet;                                                            ///< (1/mu) c there
  Net ambient, interpolated_ambient;                                    ///< the duct's flow there, and of a channel control values from it
  Net pressure_of_load, pressure_of_velocity;                           ///< the weights of f and v in (2.7); of v empty for lambda = 1
  std::vector<int> nearest;                                             ///< to a collocation point of the wall
  std::optional<stokes::Layer::Near> dual_on_wall, wall_on_sites;  ///< kept for the iterations of lambda != 1

  struct Frozen {
    FrozenOperator single, dual, wall;
    Net inlet, ambient, pressure_of_load, pressure_of_velocity;
  };
  Frozen frozen;

 private:
  void weigh_pressure(const stokes::DuctFlow& flow, bool straight);
  Net ambient_of(const stokes::DuctFlow& flow) const;
  void find_nearest(const Net& targets);

  Net flow_of_strength_;
};

}  // namespace tanktread::coupling
