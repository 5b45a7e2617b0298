#include "scene/particles/surroundings.hpp"

namespace tanktread {

namespace {

/// Returns the force of all particles on the fluid. Without contacts, the force of a deformable particle without registered loads is known exactly.
/// With contacts or registered loads, it is computed as the virtual work of all loads of the particle in a translation, in which elastic loads do no
/// work. `touching`: whether particles are in contact. The forces of contacts cancel in the sum.
Vec3 force_on_fluid(const std::vector<Member>& members, coupling::Evaluation& here, bool touching) {
  Vec3 force = Vec3::Zero();
  for (std::size_t p = 0; p < members.size(); ++p) {
    const ParticleScene& one = members[p].scene;
    if (one.particle.rigid()) force += here.rigid().force(p);
    else if (one.loads.empty() && !touching) force += members[p].body->volume * one.body_force() + one.membrane.forces.total();
    else force -= members[p].own(here.work()).colwise().sum().transpose();
  }
  return force;
}

}  // namespace

void set_surroundings(const Scene& scene, const std::vector<Member>& members, const Body& all, coupling::Capsule& capsule, coupling::Evaluation& here,
                      const coupling::Ranks& ranks, RunRow& row) {
  const Net& x = here.x();
  if (all.wall) {
    check_spread(scene, *all.wall, capsule.geometry(), x);
    row.tube = tube_row(*capsule.tube(), capsule.flow(), here);
  }
  if (const auto& cell = capsule.cell()) {
    DomainRow& now = row.domain;
    now.cell = cell->vectors();
    const Vec3 force = force_on_fluid(members, here, capsule.solver().forces().contacts.size() > 0);
    const Mat3 gradient = capsule.flow().pauses() ? Mat3::Zero() : capsule.flow().cell_gradient();
    const Mat3 axes = axes_of_shear(gradient).value_or(all.plane.of_shear.value_or(all.plane.axes));
    if (cell->n() == 3) now.set_stress(scene.flow.viscosity, gradient, *cell, axes, capsule.geometry().volume(x), row.together.stresslet, force);
    if (coupling::SolidResponse* solids = capsule.solids()) {
      const coupling::Evaluation::SolidFlow flow = here.solid_flow();
      now.pressure_gradient = capsule.flow().change() * solids->scene().driving_gradient;
      row.solids = solids_row(scene, solids->scene(), capsule.flow(), flow.flow, force, flow.velocity_integral);
    }
  }
  if (scene.has_gaps()) row.nearest = smallest_gap(members, x, ranks, capsule.cell());
  if (scene.wall.present) row.wall = wall_row(scene.wall.planes(), members, x);
}

}  // namespace tanktread
