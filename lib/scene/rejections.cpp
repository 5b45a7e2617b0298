// Combinations of choices that the program rejects.

#include <algorithm>

#include "base/rejections.hpp"
#include "scene/posts.hpp"
#include "scene/scene.hpp"
#include "scene/searches/searches.hpp"
#include "scene/tube.hpp"
#include "stokes/flow/ambient_flow.hpp"

namespace tanktread {

namespace {

/// Adds to `to` the choices that contradict user-defined loads and fields.
void reject_registered(const ParticleScene& particle_scene, Rejections& to) {
  if (to.every())  // for a given deck, Load::rigid_conditions of each load is checked instead
    to.pair(true, "Membrane/loads that depend on the position", "Domain", "such a load is not the same in all cells");
  to.pair(!particle_scene.fields.empty() && particle_scene.particle.rigid(), "Interface/fields",
          {particle_scene.particle.choice(), "Particle/motion `prescribed` or `free`"}, "only deformable particles have surface fields");
}

/// Adds to the table the sections and keys that Scene::declare refuses while it reads a deck, because they cannot be read together.
void reject_unread(Rejections& to) {
  if (!to.every()) return;
  to.pair(true, "Channel", "Tube", unread::two_ducts);
  to.pair(true, "Tube/periodic length", "Domain", unread::two_periods);
  to.pair(true, "Particles", "Particle, Membrane, Surface, Interface or Adaptation", unread::one_and_several);
  to.pair(true, "Surface", "Particle/shape `file`", unread::two_meshes);
}

}  // namespace

void reject_power(const SharedOptions& shared, bool strong, Rejections& to) {
  const stokes::FlowOptions& flow = shared.flow;
  const bool asked = shared.output.power_balance, plates = shared.wall.solid && shared.wall.distance;
  const std::string word = "Output/power balance";
  const bool quadratic = asked && flow.type != "duct" && !stokes::AmbientFlow(flow).quadratic_direction().isZero(0);
  to.pair(quadratic && shared.domain.present && !plates, word,
          {"Domain and " + flow.choice(), "Domain and Flow/type `parabolic`"},
          "the pressure of that flow does work on the flow that particles cause through a cell, which is included only between two plates");
  to.pair(asked && !shared.tube.present && flow.user && !flow.user->affine(), word, {flow.choice(), "Flow/type of an added flow"},
          "the pressure of an added flow is not known unless its gradient is uniform");
  to.pair(asked && strong, word, "Membrane/load `strong`", reason::strong);
}

void ParticleScene::reject_surroundings(Rejections& to) const {
  reject_with_tube(*this, to);
  domain.reject(*this, to);
  wall.reject(*this, to);
  reject_posts(*this, to);
}

void ParticleScene::reject(Rejections& to) const {
  reject_searches(*this, to);
  particle.reject(*this, to);
  ParticleKind::reject(*this, to);
  contact.reject(*this, to);
  reject_surroundings(to);
  reject_registered(*this, to);
  if (to.every()) {
    reject_unread(to);
    reject_power(*this, load_is_strong(), to);
    flow.reject(to);
    membrane.reject(to);
  }
}

std::string rejection_table(const Registry& registry) {
  Rejections all(true);
  ParticleScene particle_scene;
  particle_scene.registry = &registry;
  particle_scene.reject(all);
  std::vector<Rejections::Row> rows = all.rows();
  std::ranges::stable_sort(rows, {}, &Rejections::Row::one);
  std::string text = "| choice | with | why not |\n|---|---|---|\n";
  for (const Rejections::Row& row : rows) text += "| " + row.one + " | " + row.other + " | " + row.why + " |\n";
  return text;
}

}  // namespace tanktread
