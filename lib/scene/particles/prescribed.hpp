#pragma once
// Steady problem of a rigid body with prescribed motion.

#include <limits>

#include "scene/body.hpp"
#include "scene/exact_body.hpp"
#include "scene/scene.hpp"
#include "scene/series/diagnostics.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread {

/// Force and torque on the body, the traction from which they are computed, and errors. Errors are NaN if no exact solution is known.
struct RigidSolution {
  Net density;         ///< force per area on the fluid, control values; the traction on the body is its negative
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< force and torque on the body, about its centre
  Vec3 integral;       ///< force from the integral of the traction, without correction of collocation errors
  Mat3 stresslet = Mat3::Zero();
  int iterations = 0;  ///< iterations of the solver for this traction and for the corrections of the forces
  double pressure_drop = unknown;  ///< additional pressure drop caused by the body in a tube (2.7)
  double error = unknown, integral_error = unknown, torque_error = unknown;  ///< relative errors of `force`, of `integral` and of `torque`
  SurfaceErrors surface{unknown, unknown, 0};

  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
};

/// Results of a body with prescribed motion that are written as columns of a row. The columns of walls are added by WallRow and TubeRow.
struct PrescribedRow {
  RigidSolution solution;
  surface::Measures measures{0, 0, Vec3::Zero(), Mat3::Zero()};
  int n_points = 0;
  double kernel_evaluations = 0;
  void add_columns(const ParticleScene& particle_scene, Columns& to) const;
};

/// Returns the equation for the traction on the scene's body. `tube`: the tube around the body, or null.
coupling::RigidTractions make_tractions(const ParticleScene& particle_scene, const Body& body, coupling::Ranks& ranks, coupling::Tube* tube);

/// Solves for the traction on a body with `Particle/motion: prescribed` in the flow of the deck. Collective.
RigidSolution rigid_solution(const ParticleScene& particle_scene, const Body& body, coupling::RigidTractions& tractions, Phases& phases);

}  // namespace tanktread
