#pragma once
// A rigid ellipsoid on the cube mesh of six elements per side, for tests of single bodies.

#include <memory>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

/// The fitted surface has errors of 1e-5 in position and 1e-4 in the normal.
struct SingleEllipsoid {
  static constexpr double viscosity = 1.7;
  spline::TMesh mesh = spline::cube(6);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  surface::ParticleShape shape;
  Ranks ranks;
  Net rest;
  std::unique_ptr<RigidTractions> tractions;

  SingleEllipsoid(const Vec3& semi_axes, const Vec3& center) {
    shape.shape = "ellipsoid", shape.semi_axes = semi_axes, shape.center = center;
    rest = surface::resting_shape(space, mesh, shape);
    quadrature::Options quadrature;
    quadrature.tolerance = 1e-7;
    tractions = std::make_unique<RigidTractions>(
        space, rest, rest, single_body(space, shape.equivalent_radius(), viscosity, quadrature, SolverOptions()), FluidWalls(), std::vector<int>(),
        ranks);
  }
};

}  // namespace tanktread::coupling
