#include "record/plan_particles.hpp"

#include <algorithm>
#include <utility>

#include "base/formatted.hpp"
#include "membrane/strain_energy.hpp"

namespace tanktread {

namespace {

using Lines = output::Entries<std::string>;

/// `system`: whether the velocity is an unknown of a linear system.
std::string viscosity_line(const ParticleScene& particle_scene, bool system, int n_points, bool tree) {
  const bool on_lattice = particle_scene.domain.present && !particle_scene.tube.present;
  const bool assembled = particle_scene.solvers.assembled(tree) && !on_lattice;
  const char* const how = assembled ? "assembled" : "matrix-free";
  if (particle_scene.particle.viscosity_ratio == 1 && particle_scene.kelvin_voigt_membrane())
    return formatted("ratio 1: no double layer; a viscous membrane: single layer %s, a system of %d unknowns per velocity",
                     how, 3 * n_points);
  if (particle_scene.particle.viscosity_ratio == 1)
    return system ? formatted("ratio 1: no double layer; a system of %d unknowns per velocity", 3 * n_points)
                  : "ratio 1: no double layer, no system for the velocity";
  return formatted("ratio %g: double layer %s, a system of %d unknowns per velocity", particle_scene.particle.viscosity_ratio, how, 3 * n_points);
}

std::string membrane_line(const ParticleScene& particle_scene) {
  const std::size_t forces = particle_scene.membrane.forces.all.size();
  const std::string pulled = forces > 0 ? formatted(", pulled at %d patch%s", static_cast<int>(forces), forces > 1 ? "es" : "") : "";
  const auto own = particle_scene.membrane.strain_energy();
  const std::string law = own ? formatted(" with shear modulus %.6g G_s and area modulus %.6g G_s for small strains", own->shear_modulus(),
                                          own->area_modulus())
                              : "";
  const std::string memory =
      particle_scene.maxwell_membrane() ? formatted(", a Maxwell element of relaxation time %g", *particle_scene.membrane.relaxation_time) : "";
  const std::string load = particle_scene.membrane.law + law + memory + pulled + ", load " + particle_scene.membrane.load;
  if (particle_scene.load_is_strong()) return load + " at the collocation sites, as by Maestre et al. (2017)";
  if (particle_scene.membrane.fluid_interface()) return load + " per current area (3.6)";
  if (particle_scene.membrane.load_measure == "reference") return load + " per unstressed area (3.7), mass matrix factored once";
  return load + " per current area (3.6), mass matrix factored every evaluation";
}

std::string surfactant_line(const ParticleScene& particle_scene) {
  return formatted("%s equation of state, initial tension %.6g times that of the clean interface: one unknown per control point",
                   particle_scene.surfactant->equation_of_state.c_str(), particle_scene.surfactant->tension(1));
}

std::string mesh_line(const ParticleScene& particle_scene) {
  if (!particle_scene.adaptation.enabled) return "fixed";
  const bool by_error = particle_scene.adaptation.indicator == "error";
  const char* where = by_error ? "by estimated errors (1.5)" : "where curvature, traction or velocity varies (1.4)";
  return std::string("refined as the particle deforms, ") + where;
}

/// Returns the lines of the plan about one particle. `n_points`: number of control points of all particles. `tree`: true if far-field sums use
/// clusters.
Lines particle_lines(const ParticleScene& particle_scene, const VelocityUnknowns& unknowns, int n_points, bool tree) {
  Lines lines;
  if (has_given_forces(particle_scene)) lines.emplace_back("forces", "as given");
  if (!particle_scene.particle.rigid()) {
    lines.emplace_back("viscosity", viscosity_line(particle_scene, unknowns.system, n_points, tree));
    lines.emplace_back("membrane", membrane_line(particle_scene));
    if (particle_scene.surfactant) lines.emplace_back("surfactant", surfactant_line(particle_scene));
    lines.emplace_back("mesh", mesh_line(particle_scene));
    return lines;
  }
  const char* by_traction = unknowns.iterates ? "its traction, by GMRES preconditioned with factors of the bodies, for each velocity (2.40)"
                                               : "its traction, in a system that every rank factors for each velocity (2.40)";
  const char* motion = particle_scene.particle.motion == Motion::free ? "free" : "with prescribed motion";
  lines.emplace_back("body", formatted("rigid, %s: no membrane, no moving mesh; ", motion) +
                                 (unknowns.tractions ? by_traction
                                                     : formatted("a double layer, in a system of %d unknowns per velocity (2.23)", 3 * n_points)));
  return lines;
}

}  // namespace

bool has_given_forces(const ParticleScene& particle_scene) {
  const ParticleOptions& particle = particle_scene.particle;
  return particle.force || particle.torque || particle.density_difference;
}

VelocityUnknowns velocity_unknowns(const Scene& scene, const std::vector<ParticleScene>& alone) {
  VelocityUnknowns found;
  bool layers = false;  // whether a deformable particle has a double layer or a viscous membrane
  for (const ParticleScene& one : alone) {
    found.bodies |= one.particle.rigid(), found.deforms |= !one.particle.rigid();
    layers |= !one.particle.rigid() && one.has_velocity_system();
  }
  found.tractions = found.bodies && scene.by_tractions();
  found.walls = scene.tube.present && !scene.solvers.eliminates_walls() && !found.tractions;
  const bool constrained = scene.volume.constrained();
  found.multipliers = found.deforms && !found.tractions && constrained && scene.solvers.keeps_multipliers(found.walls);
  const bool other = found.tractions ? scene.tube.present || scene.domain.present : found.bodies || found.walls || found.multipliers;
  found.iterates = layers || other || !scene.equations.empty();
  found.system = found.deforms && found.iterates;
  return found;
}

void add_particles(output::Entries<std::string>& lines, const std::vector<ParticleScene>& alone, const VelocityUnknowns& unknowns, int n_points,
                   bool tree) {
  std::string last;
  for (const ParticleScene& one : alone) {
    const Lines own = particle_lines(one, unknowns, n_points, tree);
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
