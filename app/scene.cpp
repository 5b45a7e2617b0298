#include "app/scene.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "deck/words.hpp"

namespace tanktread {

void ParticleOptions::declare(deck::Section& section) {
  shape.declare(section);
  section.key("viscosity ratio", viscosity_ratio, deck::positive(), "1", "lambda: viscosity inside over viscosity outside");
  section.key("motion", motion, deck::Choice{"deforming"}, "`deforming`: by the velocity of the fluid on its surface");
}

void Scene::declare(deck::Section& root) {
  root.section("Flow", flow, "the ambient flow and the outer fluid");
  root.section("Particle", particle, "the particle at rest");
  root.section("Membrane", membrane, "what its surface is made of");
  root.section("Surface", surface, "the spline space of its surface");
  root.section("Volume", volume, "how its volume is kept");
  root.section("Quadrature", quadrature, "how integrals of the fluid are taken");
  root.section("Time", time, "integration in time");
  root.section("Adaptation", adaptation, "refinement and coarsening of the mesh");
  root.section("Solvers", solvers, "solvers of linear systems");
  root.section("Output", output, "results");
  root.section("Expect", expect, "expected results");
}

namespace {

/// Bytes of the assembled single layer that an implicit step needs: dense, single precision, three rows and columns a control point.
double assembled_bytes(double n_points) { return 9.0 * sizeof(float) * n_points * n_points; }

void check_size(const Scene& scene) {
  constexpr double limit = 64e9;
  const double n_points = scene.surface.n_points();
  if (scene.time.scheme != "tr-bdf2" || assembled_bytes(n_points) <= limit) return;
  throw UserError("Surface/mesh must have at most " + std::to_string(std::lround(std::sqrt(limit / assembled_bytes(1)))) +
                  " control points with Time/scheme `tr-bdf2`, but has " + std::to_string(std::lround(n_points)) +
                  ": their single layer takes " + std::to_string(std::lround(assembled_bytes(n_points) / 1e9)) +
                  " GB assembled, more than 64.");
}

}  // namespace

void Scene::check() const {
  flow.check();
  particle.shape.check();
  surface.check();
  membrane.check();
  time.check();
  modulus();
  if (volume.constraint == "none" && membrane.load == "weak" && membrane.load_measure == "reference")
    throw UserError(
        "Volume/constraint `none` and Membrane/load measure `reference` contradict each other: "
        "the load per reference area (3.7) needs `flux` or `exact`.");
  if (adaptation.enabled && surface.polar())
    throw UserError("Adaptation/enabled and Surface/mesh `polar` contradict each other: only the mesh `cube` can be refined.");
  check_size(*this);
}

double Scene::radius() const { return particle.shape.equivalent_radius(); }

double Scene::modulus() const { return membrane.modulus(flow.viscosity, flow.rate(), radius()); }

double Scene::snapshot_interval() const { return output.interval.value_or(time.final_time / 20.0); }

bool may_change_on_resume(const std::string& path) {
  for (const char* fixed : {"Flow", "Particle", "Membrane", "Surface", "Volume"})
    if (path.rfind(std::string(fixed) + "/", 0) == 0) return false;
  return true;
}

}  // namespace tanktread
