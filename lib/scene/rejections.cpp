// Combinations of choices that the program rejects.

#include <algorithm>

#include "base/rejections.hpp"
#include "scene/scene.hpp"
#include "scene/searches.hpp"
#include "scene/tube.hpp"
#include "stokes/flow/ambient_flow.hpp"

namespace tanktread {

namespace {

/// Adds the choices that exclude user-defined loads and fields.
void reject_registered(const Scene& scene, Rejections& to) {
  to.pair(!scene.loads.empty() && scene.load_is_strong(), "Membrane/loads", "Membrane/load `strong`",
          "loads are included by virtual work, in the form `weak` only");
  to.pair(!scene.fields.empty() && scene.particle.rigid(), "Interface/fields",
          {scene.particle.choice(), "Particle/motion `prescribed` or `free`"}, "only deformable particles have surface fields");
}

}  // namespace

void Scene::reject_power(Rejections& to) const {
  const bool asked = output.power_balance && name.empty(), between_plates = wall.solid && wall.distance && (!flow.user || flow.user->affine());
  const std::string word = "Output/power balance";
  to.pair(
      asked && flow.type != "duct" && !tube.present && !between_plates && !stokes::AmbientFlow(flow).affine(), word,
      {flow.choice(), "Flow/type `parabolic`"},
      "it is available in flows with a uniform gradient, in tubes, and between two plates if the pressure gradient of the flow is known");
  to.pair(asked && alone().front().load_is_strong(), word, "Membrane/load `strong`", "it needs the load by virtual work, `weak`");
}

void Scene::reject(Rejections& to) const {
  reject_searches(*this, to);
  particle.reject(*this, to);
  ParticleKind::reject(*this, to);
  contact.reject(*this, to);
  reject_with_tube(*this, to);
  domain.reject(*this, to);
  wall.reject(*this, to);
  reject_registered(*this, to);
  if (to.every()) {
    reject_power(to);
    flow.reject(to);
    membrane.reject(to);
  }
}

std::string rejection_table(const Registry& registry) {
  Rejections all(true);
  Scene(registry).reject(all);
  std::vector<Rejections::Row> rows = all.rows();
  std::ranges::stable_sort(rows, {}, &Rejections::Row::one);
  std::string text = "| choice | with | why not |\n|---|---|---|\n";
  for (const Rejections::Row& row : rows) text += "| " + row.one + " | " + row.other + " | " + row.why + " |\n";
  return text;
}

}  // namespace tanktread
