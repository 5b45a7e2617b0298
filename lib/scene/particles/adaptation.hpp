#pragma once
// Transfer of a particle and its state to an adapted mesh.

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

/// Result of the adaptation of one particle's mesh.
struct Adapted {
  std::unique_ptr<Body> body;            ///< body on the new mesh; null if the mesh does not change
  std::function<Net(const Net&)> move;   ///< transfers a net of the particle to the new mesh
  bool finer = true;    ///< true if the mesh was refined, false if it was coarsened
  /// largest distance, divided by R_C, by which the transfer to the new mesh has displaced a point of the current or the unstressed surface
  double change = 0;
  int refused = 0;      ///< number of bisections of elements that were left out because they would exceed `Adaptation/levels`
  bool full = false;    ///< true if bisections were left out because the mesh would exceed `Adaptation/largest number of points`
};

/// Refines the elements that the indicator marks. If no element is refined, merges elements that the indicator allows to be longer. Transfers the
/// control nets of the body to the new mesh: the unstressed, resting and initial surface. `x`: current shape of the particle. `slope`: its velocity;
/// no rows if it is unknown. `load`: control values of the load at x, per unstressed area if `per_unstressed_area` is true, otherwise per current
/// area. `films`: width of the fluid film at each element of the space body.nested(); empty if films do not cause refinement. `fields`: values of
/// the fields on the surface, scaled to order 1. The results of all ranks are equal.
Adapted adapted(const ParticleScene& particle_scene, const Body& body, const Net& x, const Net& slope, const Net& load, bool per_unstressed_area,
                std::span<const double> films, const surface::FieldsAt& fields = {});

/// Returns the warnings about an adaptation at this time: one for each limit of the section Adaptation that prevented a refinement, and one if a
/// refinement has moved the surface of a deforming particle.
std::vector<Warning> adaptation_remarks(const Member& member, const Adapted& change, double time);

/// Refines the mesh of an isolated rigid body in its initial position, according to the section Adaptation. The criteria are the shape of the body,
/// the film between body and wall, and the traction. After each refinement, fits the known shape on the new mesh. The mesh does not change afterwards
/// because the body does not deform. `force_density` returns the force per area on the mesh of its argument, as control values of shape (N, 3). It is
/// called only if Adaptation limits the error or the variation of the load. Returns the warnings of the last refinement. Collective.
std::vector<Warning> refine_isolated_body(const ParticleScene& particle_scene, Body& body, const std::function<Net(const Body& on)>& force_density);

}  // namespace tanktread
