#pragma once
// Single layer of the rigid bodies among all particles, and its factors.

#include <optional>
#include <span>
#include <vector>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/layer.hpp"
#include "stokes/medium/plane_wall.hpp"
#include "system/particle.hpp"
#include "system/ranks.hpp"

namespace tanktread::coupling {

/// The single layer (1/mu) A of (2.40) of the rigid bodies only, made regular by one flux condition per body as in (2.10). Nets have one row per
/// control point of all particles; only the rows of bodies contain force densities f. Calls are collective.
class BodyLayer {
 public:
  /// `own`: collocation points of all particles whose rows this rank computes. References must outlive this object.
  BodyLayer(std::span<const Particle> particles, double viscosity, const quadrature::Options& quadrature,
            const std::optional<stokes::PlaneWall>& wall, std::span<const int> own, Ranks& ranks);

  /// Sets the shape x with the collocation sites `at`, assembles A at the sites of the bodies, without images on a lattice, and factors it.
  /// `keep_rows`: whether `velocity` will be used for many densities.
  void place(const Net& x, const Net& at, bool keep_rows);

  /// Returns (1/mu) A f at the collocation sites of all particles. The rows of bodies are zero unless rows are kept.
  Net velocity(const Net& f);

  /// Returns the regularising term that is part of (1/mu) A f.
  Net regular(const Net& f) const;

  /// Returns the columns with the velocities at the sites, in rows of bodies, replaced by the densities that produce them. Not collective.
  Eigen::MatrixXd solved(Eigen::MatrixXd columns) const;

  const stokes::Evaluations& evaluations() const { return layer_.evaluations(); }

 private:
  void make_regular(const Net& x);

  std::vector<Particle> bodies_;   // with blocks of rows among the bodies
  std::vector<spline::Block> in_;  // block of each body among all particles
  spline::Space space_;            // common space of the bodies
  std::vector<int> points_, rows_, others_;  // control points of the bodies; their components; points in `own` of other particles
  double viscosity_;
  Ranks& ranks_;
  stokes::Layer layer_;
  Net at_, flux_, outward_;  // flux vector b of each body; a velocity field with nonzero flux, divided by this flux (2.10)
  Eigen::MatrixXd matrix_;                // kept only for `velocity`
  stokes::Rows<double> rows_of_others_;  // rows of A at the points `others_`, if kept
  std::optional<DenseFactors> factors_;
};

}  // namespace tanktread::coupling
