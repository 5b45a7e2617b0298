#include "record/plan.hpp"

#include <algorithm>
#include <utility>

#include "base/formatted.hpp"
#include "base/instruction_set.hpp"
#include "base/threads.hpp"
#include "deck/section.hpp"
#include "deck/units.hpp"
#include "record/numbers.hpp"
#include "record/plan_particles.hpp"
#include "scene/member.hpp"
#include "scene/particles/gaps.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/solids.hpp"
#include "scene/tube.hpp"
#include "stokes/layer_surface.hpp"
#include "system/solids/ducts/wall.hpp"
#include "system/frozen/frozen_operator.hpp"

namespace tanktread {

namespace {

using Lines = output::Entries<std::string>;

std::string on_ranks(int ranks) { return formatted("on %d rank%s", ranks, ranks > 1 ? "s" : ""); }

std::string kernels_line() { return instructions() + formatted(", %d thread%s", n_threads(), n_threads() > 1 ? "s" : ""); }

std::string surface_line(const Body& body) {
  return formatted("%d control points, %d elements: %s", body.space.n_points, static_cast<int>(body.space.elements.size()),
                   body.space.description.c_str());
}

/// Returns the line of the plan that describes how the unknown tractions on the wall of a tube are computed.
std::string wall_solver(const Scene& scene, const VelocityUnknowns& unknowns) {
  if (!scene.in_system()) return "eliminated from the system of the traction";
  if (unknowns.walls) return "in the system of the velocity, with the preconditioner `" + scene.solvers.tube + "`";
  if (unknowns.tractions) return "eliminated from the system of the tractions";
  return unknowns.iterates ? "eliminated from the system of the velocity" : "solved for directly";
}

/// Adds the line of the plan about the shape and the mesh of the duct's wall.
void add_duct(Lines& lines, const Scene& scene, const Body& body) {
  const surface::TubeWall& wall = *body.wall;
  const std::string section = formatted("section `%s`, R_T = %.6g", scene.tube.section.c_str(), body.duct->radius());
  const char* mesh = wall.space.description.c_str();
  switch (wall.kind) {
    case surface::DuctKind::straight_tube:
      lines.emplace_back("tube", section + formatted(", length %.6g: %s", wall.length(), mesh));
      break;
    case surface::DuctKind::channel:
      lines.emplace_back("channel", section + formatted(" at the inlet, s from %.6g to %.6g, %.6g wide where it is narrowest: %s", wall.start,
                                                        wall.end, 2 * wall.channel->smallest_radius(), mesh));
      break;
  }
}

/// Returns the sentences about values of the deck and capillary numbers whose size is unusual; empty if there are none.
std::string unusual_values(const Scene& scene) {
  std::string text;
  const auto add = [&text](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  for (const std::string& sentence : scene.unusual_values) add(sentence);
  for (const ParticleScene& one : scene.particle_scenes()) {
    if (scene.only_solids || one.particle.rigid()) continue;
    const double number = one.flow.viscosity * one.speed() / one.modulus();
    if (number <= 100 && (number >= 1e-7 || number == 0)) continue;
    add("The capillary number" + (one.name.empty() ? "" : " of " + one.path()) +
        formatted(" is %.4g, but values of 1e-07 to 100 are usual: check viscosity, velocity, size and modulus.", number));
    break;
  }
  return text;
}

void add_fluid(Lines& lines, const Scene& scene, const VelocityUnknowns& of_velocity, const Body& body, int ranks) {
  if (scene.units) lines.emplace_back("units", scene.units->description());
  if (const std::string all = unusual_values(scene); !all.empty()) lines.emplace_back("unusual", all);
  if (!body.wall) {
    const std::string history = scene.varies_in_time() ? ", changing in time" : "";
    if (const auto cell = scene.domain.cell()) {
      constexpr const char* of[] = {"length", "area", "volume"};
      lines.emplace_back("flow", scene.flow.type + history + ", in a lattice that repeats along " + scene.domain.periodic +
                                     formatted(": cell of %s %.6g, near images as sources, the rest between Chebyshev nodes", of[cell->n() - 1],
                                               cell->volume()));
      if (scene.wall.solid || !scene.posts.empty()) lines.emplace_back("solids", solids_line(scene, ranks));
      return;
    }
    std::string where = ", unbounded: no wall unknowns, no pressure drop";
    if (scene.wall.present) where = ", beside a plane wall: represented by images, no wall unknowns";
    else if (scene.domain.medium) where = ", in the medium `" + scene.domain.kind + "`: no unknowns on its boundaries";
    lines.emplace_back("flow", scene.flow.type + history + where);
    return;
  }
  const surface::TubeWall& wall = *body.wall;
  const double unknowns = 3.0 * static_cast<double>(wall.sites.size()) / body.symmetry.order();
  std::string flow = "quiescent fluid";
  if (scene.flow.type == "simple shear")
    flow = scene.flow.type + ", with which the wall moves; the flow of the empty duct is used for the pressure drop";
  if (scene.flow.type == "duct")
    flow = formatted("duct flow of mean velocity %g, pressure gradient %.6g", body.duct->mean_velocity(), -body.duct->pressure_gradient());
  lines.emplace_back("flow", flow + (scene.tube.exact_flow() ? ", exact" : formatted(" by %d boundary elements", scene.tube.flow_elements)));
  add_duct(lines, scene, body);
  if (wall.period > 0)
    lines.emplace_back("period", formatted("%.6g along x1: one period of the wall, all images by the kernels of one period", wall.period));
  const surface::Symmetry of_wall = coupling::reflections(wall, coupling::positions(wall, wall.sites));
  const double bytes = coupling::WallFactors::bytes(of_wall, body.symmetry);
  const bool iterates = surface::properties(wall.kind).may_iterate && coupling::WallSolver{scene.solvers.wall}.iterates(bytes, wall.period > 0);
  const std::string parities = of_wall.order() > 1 ? " for each parity under " + of_wall.description() : "";
  const std::string how = iterates ? "found by GMRES and clusters in each velocity, neglected in the Jacobian of implicit steps"
                                   : formatted("factored once%s: %.1f MB on each of %d rank%s", parities.c_str(), 1e-6 * bytes, ranks,
                                               ranks > 1 ? "s" : "");
  lines.emplace_back("wall",
                     formatted("%.0f unknowns of the traction and the pressure drop, %s; ", unknowns, wall_solver(scene, of_velocity).c_str()) + how);
}

/// Returns whether mesh points of a particle slide along its interface, so that their velocity is not that of the fluid.
bool slides(const std::vector<ParticleScene>& all) {
  return std::ranges::any_of(
      all, [](const ParticleScene& one) { return !one.particle.rigid() && one.interface_motion() != coupling::MeshMotion::material; });
}

/// Returns the line of the plan about the time scheme and the size of the frozen operator (the single layer in the Jacobian of implicit steps).
/// `n`: number of control points. `rows`: number of control points whose rows are assembled.
std::string time_line(const Scene& scene, const VelocityUnknowns& unknowns, double n, double rows, int ranks) {
  const bool chosen = scene.time.scheme == "auto";
  const std::string scheme = scene.time.scheme + (chosen ? ", bs3 or tr-bdf2 by the measured stiffness" : "");
  if (!scene.time.assembles() && !chosen) return scheme + ", explicit in the fluid: nothing is assembled";
  const std::vector<ParticleScene> all = scene.particle_scenes();
  const bool contrast = std::ranges::any_of(all, [](const ParticleScene& one) { return one.particle.viscosity_ratio != 1; });
  const bool assembled = scene.solvers.assembles_frozen(contrast, n);
  std::string line = scheme + ", frozen single layer ";
  if (assembled) line += formatted("of %.1f MB ", 1e-6 * coupling::FrozenOperator::bytes_a_pair * n * rows) + on_ranks(ranks);
  else line += "by one node per control point, not assembled";
  if (scene.domain.present && !scene.tube.present) line += ", without images on the lattice";
  if (scene.wall.present && !scene.wall.solid && !assembled) line += ", without images in the wall";
  if ((unknowns.iterates || unknowns.tractions) && (slides(all) || unknowns.bodies || unknowns.walls))
    line += "; each evaluation of a step solves the system for velocities";
  return line;
}

/// Adds the lines about steady shapes, periodic motions, branches and spectra, which replace the line `time` of the plan.
void add_steady(Lines& lines, const Scene& scene, const Body& body) {
  if (scene.steady.present)
    lines.emplace_back("steady", "the steady shape, by " + scene.steady.method + " of NOX on implicit steps with the frozen Jacobian");
  if (scene.periodic.present) lines.emplace_back("periodic", "a periodic motion, as the fixed point of runs over one period");
  if (scene.continuation.present)
    lines.emplace_back("branch", formatted("along %s to %g, ", scene.continuation.parameter.c_str(), scene.continuation.to) +
                                     scene.continuation.method + ", each point by a separate iteration");
  if (const auto& second = scene.continuation.second_parameter)
    lines.emplace_back("folds", formatted("the first one at %zu values of %s", scene.continuation.second_values->size(), second->c_str()));
  if (!scene.spectrum.present) return;
  const bool material = scene.first().interface_motion() == coupling::MeshMotion::material;
  const auto unknowns = static_cast<int>(body.symmetry.fundamental().size()) * (material ? 3 : 1);
  const bool dense = scene.spectrum.method == "dense";
  lines.emplace_back("spectrum", dense ? formatted("%d unknowns at most: as many pairs of velocities for the Jacobian, all its eigenvalues", unknowns)
                                       : formatted("%d unknowns at most: block Krylov-Schur on the shift-inverted motion", unknowns));
}

std::string symmetry_line(const Scene& scene, const Body& body) {
  if (body.symmetry.order() == 1 && scene.symmetry.use == "none") return "none used";
  if (const std::string where = lacks_symmetry(scene.first(), body); !where.empty()) return "not searched for " + where;
  if (body.symmetry.order() == 1) return "none found";
  const int evaluated = static_cast<int>(body.symmetry.fundamental().size());
  return body.symmetry.description() +
         formatted(
             ": %d of %d control points evaluated, %.2g times fewer; instabilities that break the symmetry are excluded (Symmetry/use)",
             evaluated, body.space.n_points, double(body.space.n_points) / evaluated);
}

/// Returns the line of the plan that lists the linear systems that are solved iteratively, with their solvers.
std::string solvers_line(const Scene& scene, const VelocityUnknowns& unknowns) {
  const coupling::SolverOptions& solvers = scene.solvers;
  std::string line;
  const auto add = [&](const char* system, const coupling::IterativeOptions& options) {
    const coupling::IterativeOptions own = solvers.of(options);
    line += (line.empty() ? "" : "; ") + std::string(system) + " by " + *own.solver;
    if (own.preconditioner != "own") line += ", preconditioner `" + own.preconditioner + "`";
  };
  if (!scene.in_system()) {
    if (scene.tube.present) add("traction", solvers.traction);
    return line.empty() ? "no iterative solver" : line;
  }
  if (unknowns.iterates) {
    add("velocity", solvers.velocity);
    if (slides(scene.particle_scenes()) || unknowns.bodies) line += ", without an initial guess";
  }
  if (!scene.runs_in_time() || scene.time.assembles() || scene.time.scheme == "auto") add("implicit step", solvers.implicit_step);
  if (scene.steady.present && scene.steady.method == "newton-krylov") add("steady", solvers.steady);
  if (scene.spectrum.present && scene.spectrum.method == "krylov") add("spectrum", solvers.spectrum);
  return line.empty() ? "no iterative solver" : line;
}

/// Returns the line of the plan that names the blocks of unknowns of a velocity (coupling::System), and those that are eliminated.
std::string blocks_line(const Scene& scene, const VelocityUnknowns& unknowns) {
  const bool constrained = unknowns.deforms && scene.volume.constrained();
  std::string unknown, eliminated;
  const auto add = [](bool present, std::string& list, const std::string& block) {
    if (present) list += (list.empty() ? "" : ", ") + block;
  };
  add(unknowns.system, unknown, "velocities");
  add(unknowns.bodies, unknown, unknowns.tractions ? "tractions of rigid bodies" : "double-layer densities of rigid bodies");
  add(unknowns.walls, unknown, "wall traction, pressure drop");
  add(unknowns.multipliers, unknown, "volume multipliers");
  add(unknowns.tractions, eliminated, "motions of rigid bodies (unit motions)");
  add(scene.tube.present && !unknowns.walls, eliminated, "wall traction and pressure drop (response)");
  add(scene.wall.solid || !scene.posts.empty(), eliminated, "tractions of plates and posts (response)");
  add(constrained && !unknowns.multipliers, eliminated, "volume multipliers (projection)");
  if (unknowns.deforms && !unknowns.system) unknown += (unknown.empty() ? "" : "; ") + std::string("velocities computed without a system");
  return unknown + (eliminated.empty() ? "" : "; eliminated: " + eliminated);
}

/// Returns the line of the plan about a rigid particle: that its motion is prescribed, or how its free motion is computed.
std::string rigid_line(const ParticleScene& particle_scene, const Body& body) {
  if (particle_scene.particle.motion == Motion::prescribed) return "rigid, its motion prescribed: no membrane, nothing moves in time";
  if (body.wall || particle_scene.medium()) return "rigid and free, no membrane: its motion is computed with the traction, at each position";
  return std::string("rigid and free, no membrane: six rigid motions") +
         (body.flow.affine() ? " and five strains" : ", five strains and eighteen quadratic fields") +
         ", solved once, determine its motion";
}

Lines plan_of_rigid(const Scene& scene, const Body& body, int ranks) {
  const int n = body.space.n_points;
  const ParticleScene only = scene.first();
  Lines lines = {{"surface", std::to_string(n) + " control points: " + body.space.description},
                 {"unknowns", formatted("%d of the traction: single layer of the first kind, its null space made regular", 3 * n)}};
  add_fluid(lines, scene, {}, body, ranks);
  lines.emplace_back("particle", rigid_line(only, body));
  const bool free = only.particle.motion == Motion::free;
  const char* const integrals = only.reciprocal_forces() ? "corrected by the reciprocal theorem: six more solves" : "integrals of the traction";
  lines.emplace_back("forces", !free ? integrals : has_given_forces(only) ? "as given" : "none");
  lines.emplace_back("time", free ? scene.time.scheme + " for centre and orientation" : "steady");
  lines.emplace_back("solvers", solvers_line(scene, {}));
  lines.emplace_back("assembled", formatted("%.1f MB on every rank, factored", (scene.tube.present ? 144e-6 : 72e-6) * n * n));
  lines.emplace_back("kernels", kernels_line());
  lines.emplace_back("numbers", numbers_text(numbers(scene, body)));
  if (only.adaptation.enabled)
    lines.emplace_back("mesh", "refined once at the initial position, where the shape, a film or the traction needs it");
  lines.emplace_back("symmetry", "none used");
  return lines;
}

}  // namespace

output::Entries<std::string> plan(const Scene& scene, const Body& body, int ranks) {
  if (!scene.in_system()) return plan_of_rigid(scene, body, ranks);
  const bool tree = stokes::sums_by_tree(body.space, scene.quadrature, scene.domain.present && !scene.tube.present ? stokes::lattice_images : 1);
  const std::vector<ParticleScene> alone = scene.particle_scenes();
  const VelocityUnknowns unknowns = velocity_unknowns(scene, alone);
  const bool several = alone.size() > 1;
  const int n = body.space.n_points;
  Lines lines;
  if (several) lines.emplace_back("particles", formatted("%zu, in one system", alone.size()));
  lines.emplace_back("surface", several ? formatted("%d control points, %zu elements in all", n, body.space.elements.size()) : surface_line(body));
  lines.emplace_back("unknowns", formatted("%d positions", 3 * n));
  add_fluid(lines, scene, unknowns, body, ranks);
  if (!several && !alone.front().particle.rigid()) {
    lines.emplace_back("deformation", body.plane.description());
    lines.emplace_back("numbers", numbers_text(numbers(scene, body)));
  }
  lines.emplace_back("far sum", tree ? "by clusters of nodes and targets, to the tolerance of the quadrature" : "every target with every node");
  lines.emplace_back("kernels", kernels_line());
  if (scene.has_gaps())
    lines.emplace_back("contact",
                       formatted(scene.contact.limiter ? "gaps between particles are kept at %g R_C or above by repulsive forces (4.23)"
                                                       : "a gap between particles below %g R_C ends the run; no contact forces",
                                 scene.contact.limit));
  lines.emplace_back("volume", deck::word(coupling::volume_constraints, scene.volume.constraint) + (several ? ", of each" : ""));
  if (scene.runs_in_time())
    lines.emplace_back("time", time_line(scene, unknowns, n, static_cast<double>(body.symmetry.fundamental().size()), ranks));
  else
    add_steady(lines, scene, body);
  lines.emplace_back("blocks", blocks_line(scene, unknowns));
  lines.emplace_back("solvers", solvers_line(scene, unknowns));
  lines.emplace_back("symmetry", several ? "not searched for among several particles" : symmetry_line(scene, body));
  add_particles(lines, alone, unknowns, n, tree);
  return lines;
}

output::Entries<std::string> plan(const Scene& scene, int ranks) {
  if (scene.only_solids) {
    Lines lines;
    add_fluid(lines, scene, {}, Body(), ranks);
    lines.emplace_back("time", "steady: nothing moves");
    return lines;
  }
  std::vector<Member> all = checked_members(scene);
  arrange(all);
  const std::unique_ptr<Body> stacked = make_stacked_body(all);
  if (stacked && scene.tube.present) stacked->wall = make_wall(scene, *stacked);
  Lines lines = plan(scene, stacked ? *stacked : *all.front().body, ranks);
  for (const Warning& warning : first_warnings(scene)) lines.emplace_back("warning", warning.sentence);
  return lines;
}

std::string plan_text(const output::Entries<std::string>& plan) {
  std::string text = "plan\n";
  for (const auto& [what, how] : plan) text += formatted("  %-11s ", what.c_str()) + how + "\n";
  return text;
}

}  // namespace tanktread
