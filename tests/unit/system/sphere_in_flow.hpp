#pragma once
// A unit sphere in an unbounded flow, with everything needed to construct a Capsule.

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"
#include "system/capsule.hpp"

namespace tanktread::coupling {

struct SphereInFlow {
  spline::TMesh mesh;
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net sphere = surface::resting_shape(space, mesh, {});
  stokes::FlowOptions flow;
  CapsuleParameters parameters;
  Phases phases;

  SphereInFlow(int elements_per_side, const char* type) : mesh(spline::cube(elements_per_side)) { flow.type = type; }

  Capsule capsule() { return Capsule(space, sphere, sphere, stokes::AmbientFlow(flow), parameters, phases); }
};

}  // namespace tanktread::coupling
