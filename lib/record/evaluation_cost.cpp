#include "record/evaluation_cost.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "record/results.hpp"
#include "scene/particles/particle_system.hpp"
#include "system/solids/shared_walls.hpp"

namespace tanktread {

namespace {

constexpr double longest = 5;  // largest allowed duration of a timed evaluation, in seconds

/// Measured cost of one velocity evaluation: seconds of the setup and of the evaluation, kernel evaluations on all ranks, and number of mesh
/// elements.
struct Cost {
  double setup, seconds, kernel_evaluations, elements;
  long memory;  // peak memory of all ranks in bytes
  std::string system;
};

/// Builds the particles of a scene and evaluates their velocity once, in the initial shape. Returns the cost of both. Collective.
Cost measured(const Scene& scene) {
  coupling::Ranks ranks;
  Phases phases;
  const auto start = std::chrono::steady_clock::now();
  const auto particles = make_particle_system(scene, ranks, phases);
  coupling::Dynamics& dynamics = particles->dynamics();
  const coupling::State x = particles->start();
  dynamics.set_time(0, 0);
  Cost cost{};
  cost.setup = ranks.seconds_since(start);
  const auto evaluations = [&] { return ranks.of_all(particles->kernel_evaluations() + scene.walls->evaluations()).total(); };
  const auto before = evaluations();
  const auto evaluation = std::chrono::steady_clock::now();
  dynamics.velocity(x);
  cost.seconds = ranks.seconds_since(evaluation);
  cost.kernel_evaluations = static_cast<double>(evaluations() - before);
  cost.elements = static_cast<double>(particles->body().space.elements.size());
  cost.memory = peak_memory(ranks).back().second;
  if (coupling::Capsule* const capsule = particles->capsule()) cost.system = capsule->plan();
  return cost;
}

/// Divides the numbers of elements of a mesh by `divisor`, but keeps at least six azimuthal elements and at least three along other directions.
/// Returns true if a number has changed.
bool coarsen(surface::MeshOptions& mesh, int divisor) {
  bool changed = false;
  for (auto* elements : {&mesh.elements_per_side, &mesh.azimuthal_elements, &mesh.meridional_elements}) {
    if (!*elements) continue;
    const int fewer = std::max(elements == &mesh.azimuthal_elements ? 6 : 3, **elements / divisor);
    changed |= fewer < **elements;
    *elements = std::min(**elements, fewer);
  }
  return changed;
}

/// Divides the numbers of mesh elements of all particles by `divisor`. Returns true if any of these numbers has changed.
bool coarsen(Scene& scene, int divisor) {
  bool changed = false;
  for (ParticleKind& kind : scene.particles) changed |= coarsen(kind.surface, divisor);
  return changed;
}

/// Returns the number of elements of all particles on the meshes of the deck. A particle whose shape comes from a file has the mesh of the file.
double elements(const Scene& scene) {
  double sum = 0;
  for (const ParticleKind& one : scene.particles) {
    const auto& imported = one.particle.shape.imported;
    sum += imported ? static_cast<double>(imported->space.elements.size()) : one.surface.n_elements();
  }
  return sum;
}

}  // namespace

output::Entries<std::string> evaluation_cost(const Scene& scene) {
  if (!scene.in_system() && scene.first().particle.motion != Motion::free) return {};
  for (const int divisor : {4, 2}) {
    Scene coarse = scene;
    coarse.walls = std::make_shared<coupling::SharedWalls>();  // walls keep a pointer to the Phases of measured()
    if (!coarsen(coarse, divisor)) continue;
    Cost cost{};
    try {
      cost = measured(coarse);
    } catch (const UserError&) {
      continue;  // the scene is not valid on this coarse mesh: tries the next finer mesh
    }
    const double ratio = elements(scene) / cost.elements, seconds = cost.seconds * ratio * ratio;
    if (seconds > longest)
      return {{"evaluation", formatted("not timed, because one velocity evaluation would take about %.0f s, as follows from %.2g s on %.0f elements",
                                       seconds, cost.seconds, cost.elements)}};
    break;
  }
  const Cost cost = measured(scene);
  output::Entries<std::string> lines;
  if (!cost.system.empty()) lines.emplace_back("system", cost.system);
  lines.emplace_back("evaluation", formatted("%.3g kernel evaluations and %.2g s for one velocity, after %.2g s of setup", cost.kernel_evaluations,
                                             cost.seconds, cost.setup));
  lines.emplace_back("memory", formatted("%.0f MB of all ranks, without the Jacobian of implicit steps", 1e-6 * static_cast<double>(cost.memory)));
  return lines;
}

}  // namespace tanktread
