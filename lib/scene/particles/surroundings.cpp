#include "scene/particles/surroundings.hpp"

namespace tanktread {

namespace {

/// Returns the force of all particles on the fluid. The force of a deformable particle is minus the sum of dE/dx over its control points, to which
/// elastic loads do not contribute. `touching`: whether particles are in contact. The forces of contacts cancel in the sum over all particles. A
/// particle on which no force acts is left out, because its sum is a rounding error.
Vec3 force_on_fluid(const std::vector<Member>& members, coupling::Evaluation& here, bool touching) {
  Vec3 force = Vec3::Zero();
  for (std::size_t p = 0; p < members.size(); ++p) {
    const ParticleScene& one = members[p].scene;
    if (one.particle.rigid()) force += here.rigid().force(p);
    else if (touching || !one.net_force().empty() || !one.loads.empty()) force -= members[p].own(here.virtual_work()).colwise().sum().transpose();
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
