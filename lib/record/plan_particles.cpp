#include "record/plan_particles.hpp"

#include <algorithm>
#include <utility>

#include "base/formatted.hpp"
#include "membrane/strain_energy.hpp"

namespace tanktread {

namespace {

using Lines = output::Entries<std::string>;

std::string viscosity_line(const ParticleScene& scene, int n_points, bool tree) {
  const bool assembled = scene.solvers.assembled(tree) && (scene.tube.present || !scene.domain.present);  // never on a lattice
  const char* const how = assembled ? "assembled" : "matrix-free";
  if (scene.particle.viscosity_ratio == 1 && scene.kelvin_voigt_membrane())
    return formatted("ratio 1: no double layer; a viscous membrane: single layer %s, a system of %d unknowns per velocity",
                     how, 3 * n_points);
  if (scene.particle.viscosity_ratio == 1) return "ratio 1: no double layer, no system for the velocity";
  return formatted("ratio %g: double layer %s, a system of %d unknowns per velocity", scene.particle.viscosity_ratio, how, 3 * n_points);
}

std::string membrane_line(const ParticleScene& scene) {
  const std::size_t forces = scene.membrane.forces.all.size();
  const std::string pulled = forces > 0 ? formatted(", pulled at %d patch%s", static_cast<int>(forces), forces > 1 ? "es" : "") : "";
  const auto own = scene.membrane.strain_energy();
  const std::string law = own ? formatted(" with shear modulus %.6g G_s and area modulus %.6g G_s for small strains", own->shear_modulus(),
                                          own->area_modulus())
                              : "";
  const std::string memory =
      scene.maxwell_membrane() ? formatted(", a Maxwell element of relaxation time %g", *scene.membrane.relaxation_time) : "";
  const std::string load = scene.membrane.law + law + memory + pulled + ", load " + scene.membrane.load;
  if (scene.load_is_strong()) return load + " at the collocation sites, as by Maestre et al. (2017)";
  if (scene.membrane.fluid_interface()) return load + " per current area (3.6)";
  if (scene.membrane.load_measure == "reference") return load + " per unstressed area (3.7), mass matrix factored once";
  return load + " per current area (3.6), mass matrix factored every evaluation";
}

std::string surfactant_line(const ParticleScene& scene) {
  return formatted("%s equation of state, initial tension %.6g times that of the clean interface: one unknown per control point",
                   scene.surfactant->equation_of_state.c_str(), scene.surfactant->tension(1));
}

std::string mesh_line(const ParticleScene& scene) {
  if (!scene.adaptation.enabled) return "fixed";
  const char* where = scene.adaptation.indicator == "error" ? "by estimated errors (1.5)" : "where curvature, traction or velocity varies (1.4)";
  return std::string("refined as the particle deforms, ") + where;
}

/// Returns the lines of the plan about one particle. `n_points`: number of control points of all particles. `tree`: true if far-field sums use
/// clusters. `responds`: true if the tractions of rigid bodies are found by GMRES, because the scene has a tube, a periodic domain, or a deforming
/// particle whose velocity is found from a linear system.
Lines particle_lines(const ParticleScene& one, int n_points, bool tree, bool responds) {
  if (!one.particle.rigid()) {
    Lines lines = {{"viscosity", viscosity_line(one, n_points, tree)}, {"membrane", membrane_line(one)}};
    if (one.surfactant) lines.emplace_back("surfactant", surfactant_line(one));
    lines.emplace_back("mesh", mesh_line(one));
    return lines;
  }
  const bool first_kind = one.solvers.rigid_bodies == coupling::BodyEquation::first_kind;
  const char* by_traction = responds ? "its traction, by GMRES preconditioned with factors of the bodies, for each velocity (2.40)"
                                     : "its traction, in a factored system for each velocity (2.40)";
  return {{"body", formatted("rigid, %s: no membrane, no moving mesh; ", one.particle.motion == Motion::free ? "free" : "with prescribed motion") +
                       (first_kind ? by_traction : formatted("a double layer, in a system of %d unknowns per velocity (2.23)", 3 * n_points))}};
}

}  // namespace

void add_particles(output::Entries<std::string>& lines, const std::vector<ParticleScene>& alone, int n_points, bool tree) {
  std::string last;
  const bool responds = std::ranges::any_of(alone, [](const ParticleScene& one) {
    return one.tube.present || one.domain.present || (!one.particle.rigid() && one.has_velocity_system());
  });
  for (const ParticleScene& one : alone) {
    const Lines own = particle_lines(one, n_points, tree, responds);
    if (alone.size() == 1) {
      lines.insert(lines.end(), own.begin(), own.end());
      return;
    }
    std::string line;
    for (const auto& [what, how] : own) line += (line.empty() ? "" : "; ") + what + ": " + how;
    if (lines.back().second == line)
      last = " … " + one.name;
    else
      lines.back().first += std::exchange(last, {}), lines.emplace_back(one.name, line);
  }
  lines.back().first += last;
}

}  // namespace tanktread
