#pragma once
// The same particle on another mesh.

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "motion/integrator.hpp"
#include "scene/body.hpp"
#include "scene/member.hpp"
#include "scene/particles/warnings.hpp"
#include "spline/space.hpp"

namespace tanktread {

/// A body and the state of its run, of all particles, after a change of its mesh.
struct Adapted {
  std::unique_ptr<Body> body;  ///< none: the mesh stays as it is
  motion::State state;
  bool finer = true;    ///< refined; otherwise coarsened
  double change = 0;    ///< largest change of the unstressed and the present surface, over R_C: the residual of the transfer
  int refused = 0;      ///< cuts that `Adaptation/levels` does not leave room for
  bool full = false;    ///< whether cuts were left out for `Adaptation/largest number of points`
};

/// Cuts what the indicator marks, or takes back what it allows to be longer. Every field of the state goes along: both surfaces, the scheme's
/// slopes, the geometry of the frozen operator, whose rows of other particles than `block` stay. `load`: control values of this particle's load at
/// state.x, per area of the unstressed surface if `per_unstressed_area`. `films`: the width beside each element of body.nested(), or none. `fields`:
/// values of the fields on the surface, scaled to order 1. The same on every rank.
Adapted adapted(const Scene& scene, const Body& body, const spline::Block& block, const motion::State& state, const Net& load,
                bool per_unstressed_area, std::span<const double> films, const surface::FieldsAt& fields = {});

/// Returns warnings about what a change of the mesh at this time lacks.
std::vector<Warning> adaptation_remarks(const Member& member, const Adapted& change, double time);

/// Refines the mesh of a rigid body that is alone, at its first place, as Adaptation says of its shape, the film to a wall and the traction, and fits
/// the shape again. The mesh stays from then on, because the body does not deform. `force_density`: control values, shape (N, 3), force/area, on the
/// mesh that it is given; called only if Adaptation limits the error or the variation of the load. Collective.
void refine_alone(const Scene& scene, Body& body, const std::function<Net(const Body& on)>& force_density);

}  // namespace tanktread
