#pragma once
// Sphere in a tube, for comparisons with exact solutions.

#include <cmath>
#include <memory>
#include <numbers>

#include "base/timing.hpp"
#include "spline/extraction.hpp"
#include "spline/polar.hpp"
#include "spline/t_mesh.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/shapes.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solids/bodies/bounded_free_body.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"
#include "system/solids/ducts/tube.hpp"

namespace tanktread {

/// Spline space and control net of a sphere of radius a about `centre`.
struct Sphere {
  spline::Space space;
  Net net;
  double radius;
  Vec3 centre;
};

/// Returns a sphere of the cube mesh with n elements per side.
inline Sphere sphere(double a, const Vec3& centre, int n) {
  const spline::TMesh mesh = spline::cube(n);
  Sphere s{spline::space(mesh, spline::ExtraordinaryRule::g1), {}, a, centre};
  surface::ParticleShape shape;
  shape.radius = a, shape.center = centre;
  s.net = surface::resting_shape(s.space, mesh, shape);
  return s;
}

/// Returns a sphere with poles on the x1 axis, m elements around it and r from pole to pole.
inline Sphere polar_sphere(double a, const Vec3& centre, int m, int r) {
  spline::PolarMesh mesh;
  mesh.azimuthal = m, mesh.meridional = r, mesh.poles = spline::PoleRule::c1;
  Sphere s{spline::space(mesh), {}, a, centre};
  surface::ParticleShape shape;
  shape.radius = a, shape.center = centre;
  s.net = surface::resting_shape(s.space, mesh, 0, shape);
  return s;
}

/// Duct with mean velocity 1 and viscosity 1, and its wall.
struct Duct {
  std::shared_ptr<const stokes::DuctFlow> flow;
  surface::TubeWall wall;

  Duct(std::shared_ptr<const stokes::DuctFlow> own_flow, const surface::TubeOptions& options, double length)
      : flow(std::move(own_flow)), wall(surface::tube_wall(flow->outline(), options, length)) {}

  stokes::AmbientFlow ambient() const {
    stokes::FlowOptions options;
    options.type = "duct";
    options.mean_velocity = 1;
    return stokes::AmbientFlow(options, flow);
  }
};

/// Returns a duct of radius 1; by default with the default wall.
inline Duct circular_duct(int around = 24, int along = 25, double length = 2 * std::numbers::pi) {
  surface::TubeOptions options;
  options.present = true;
  options.radius = 1;
  options.azimuthal_elements = around, options.axial_elements = along;
  return {std::make_shared<stokes::DuctFlow>(options, 1.0, 1.0), options, length};
}

/// Rigid sphere in the duct.
struct RigidSphere {
  Sphere sphere;
  coupling::Ranks ranks;
  Phases phases;
  coupling::SolverOptions solvers;
  stokes::AmbientFlow flow;
  std::unique_ptr<coupling::Tube> tube;
  std::unique_ptr<coupling::RigidTractions> tractions;
  std::unique_ptr<coupling::FreeBodyInTube> body;
  double radius;

  RigidSphere(Sphere given, const Duct& duct, double tolerance = 1e-7) : sphere(std::move(given)), flow(duct.ambient()), radius(sphere.radius) {
    coupling::TubeParameters parameters;
    parameters.quadrature.tolerance = tolerance;
    solvers.tolerance = 1e-9;
    tube = std::make_unique<coupling::Tube>(duct.wall, *duct.flow, sphere.space, parameters, phases);
    const coupling::CapsuleParameters single = single_body(sphere.space, radius, 1.0, parameters.quadrature, solvers);
    tube->set_particles(sphere.net, single.particles);
    tractions = std::make_unique<coupling::RigidTractions>(sphere.space, sphere.net, sphere.net, single, coupling::FluidWalls{tube.get()},
                                                           std::vector<int>(), ranks);
    body = std::make_unique<coupling::FreeBodyInTube>(*tractions, sphere.net, sphere.centre, radius, flow, 1.0);
  }

  /// Axial force on the fluid divided by 6 pi mu a, and the pressure drop.
  struct Resistance {
    double drag, pressure_drop;
  };

  /// Return the resistance of the sphere towed along the axis with unit speed in quiescent fluid, and of the sphere held in the flow.
  Resistance towed() {
    stokes::FlowOptions at_rest;
    at_rest.type = "quiescent";
    return resistance({true, {Vec3::UnitX(), Vec3::Zero()}}, stokes::AmbientFlow(at_rest));
  }
  Resistance held() { return resistance({true, {}}, flow); }

 private:
  Resistance resistance(const coupling::RigidDrive& driven, const stokes::AmbientFlow& in) {
    tube->set_shape(sphere.net);
    const auto& solution = tractions->solve(sphere.net, {&sphere.centre, 1}, {&driven, 1}, in);
    return {solution.bodies.front().force[0] / (6 * std::numbers::pi * radius), solution.pressure_correction - tube->pressure_of(solution.unknowns)};
  }
};

}  // namespace tanktread
