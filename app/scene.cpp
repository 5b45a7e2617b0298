#include "app/scene.hpp"

#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "deck/words.hpp"

namespace tanktread {

void ParticleOptions::declare(deck::Section& section) {
  shape.declare(section);
  section.key("viscosity ratio", viscosity_ratio, deck::positive(), "1", "lambda: viscosity inside over viscosity outside");
  section.key("motion", motion, deck::Choice{"deforming", "prescribed", "free"},
              "`deforming`: by the velocity of the fluid on its surface; `prescribed`: rigid, with `velocity` and `angular velocity`, a steady "
              "problem; `free`: rigid, without force or torque");
  section.key("velocity", velocity, deck::any(), "length/time", "of the centre, for a `prescribed` motion; zero if not given");
  section.key("angular velocity", angular_velocity, deck::any(), "1/time", "about the centre, for a `prescribed` motion; zero if not given");
  section.key("drift", drift, deck::Choice{"free", "held"},
              "`held`: the centroid is put back after every step, which in an affine flow changes no shape; the default at the point of rest of a "
              "flow that draws away from it, where rounding grows into a drift; otherwise `free`");
  section.key("forces", forces, deck::Choice{"reciprocal", "integral"},
              "force and torque on a `prescribed` body: `integral` of the traction alone, as the paper has it, or with what that lacks by the "
              "`reciprocal` theorem, the default under Quadrature/rule `adaptive`; the other rules are too coarse for it");
}

void Scene::declare(deck::Section& root) {
  root.section("Flow", flow, "the ambient flow and the outer fluid");
  root.section("Particle", particle, "the particle at rest");
  membrane_given = root.given("Membrane");
  volume_given = root.given("Volume");
  const bool deforming = !particle.rigid();
  if (deforming || membrane_given) root.section("Membrane", membrane, "what its surface is made of");
  if (particle.shape.shape != "file")
    root.section("Surface", surface, "the spline space of its surface");
  else if (root.given("Surface"))
    throw UserError("Surface and Particle/shape `file` contradict each other: the spline space is the file's.");
  tube.present = root.given("Tube");
  if (tube.present || root.documenting()) root.section("Tube", tube, "a straight tube along x1 around the particle; none without this list");
  if (deforming || volume_given) root.section("Volume", volume, "how its volume is kept");
  root.section("Quadrature", quadrature, "how integrals of the fluid are taken");
  root.section("Time", time, "integration in time");
  root.section("Interface", interface, "how the mesh of a drop moves along its interface");
  root.section("Adaptation", adaptation, "refinement and coarsening of the mesh");
  root.section("Symmetry", symmetry, "what of the scene is solved for");
  root.section("Solvers", solvers, "solvers of linear systems");
  root.section("Output", output, "results");
  root.section("Expect", expect, "expected results");
}

namespace {

/// Bytes of the assembled single layer that an implicit step needs: dense, single precision, three rows and columns a control point.
double assembled_bytes(double n_points) { return 9.0 * sizeof(float) * n_points * n_points; }

void check_size(const Scene& scene) {
  constexpr double limit = 64e9;
  const auto& imported = scene.particle.shape.imported;
  const double n_points = imported ? imported->space.n_points : scene.surface.n_points(), most = std::sqrt(limit / assembled_bytes(1));
  if (scene.solvers.frozen_operator == "nodal" && scene.particle.viscosity_ratio == 1) return;
  if ((!scene.time.assembles() && scene.time.scheme != "auto") || n_points <= most) return;  // auto measures stiffness with it
  const auto number = [](double x) { return std::to_string(std::lround(x)); };
  const std::string size =
      number(n_points) + " control points takes " + number(assembled_bytes(n_points) / 1e9) + " GB assembled, more than 64.";
  if (imported)
    throw UserError("Particle/file must hold at most " + number(std::floor(most)) + " control points with Time/scheme `" + scene.time.scheme +
                    "`: the single layer of " + size);
  if (scene.surface.polar())
    throw UserError("Surface/azimuthal elements and Surface/meridional elements must give at most " + number(std::floor(most)) +
                    " control points with Time/scheme `" + scene.time.scheme + "`: the single layer of " + size);
  throw UserError("Surface/elements per side must be at most " + number(std::floor(std::sqrt((most - 2) / 6))) +
                  " with Time/scheme `" + scene.time.scheme + "`, but is " + std::to_string(*scene.surface.elements_per_side) +
                  ": the single layer of its " + size);
}

}  // namespace

namespace {

void check_motion(const Scene& scene) {
  const ParticleOptions& particle = scene.particle;
  const std::string motion = "Particle/motion `" + particle.motion + "`";
  if (particle.motion != "prescribed" && (particle.velocity || particle.angular_velocity))
    throw UserError(std::string("Particle/") + (particle.velocity ? "velocity" : "angular velocity") +
                    " belongs to Particle/motion `prescribed`, but Particle/motion is `" + particle.motion + "`.");
  if (!particle.rigid()) return;
  if (scene.membrane_given) throw UserError("Membrane and " + motion + " contradict each other: a rigid particle has no membrane.");
  if (scene.volume_given) throw UserError("Volume and " + motion + " contradict each other: a rigid particle keeps its volume.");
  if (particle.viscosity_ratio != 1)
    throw UserError("Particle/viscosity ratio and " + motion + " contradict each other: there is no fluid in a rigid particle.");
  if (scene.adaptation.enabled)
    throw UserError("Adaptation/enabled and " + motion + " contradict each other: the mesh of a rigid particle stays as it is.");
  if (scene.time.steady_tolerance)
    throw UserError("Time/steady tolerance and " + motion + " contradict each other: it ends runs of a particle that deforms.");
}

}  // namespace

namespace {

void check_tube(const Scene& scene) {
  const std::string flow = "Flow/type `" + scene.flow.type + "`";
  if (!scene.tube.present) {
    if (scene.flow.type == "duct") throw UserError(flow + " needs a list Tube, at least Tube/section.");
    return;
  }
  scene.tube.check();
  if (scene.flow.type != "duct" && scene.flow.type != "quiescent")
    throw UserError("Tube and " + flow + " contradict each other: that flow fills unbounded space; in a tube Flow/type is `duct` or `quiescent`.");
  if (scene.quadrature.rule == "desingularised")
    throw UserError("Quadrature/rule `desingularised` and Tube contradict each other: the wall is not closed.");
}

}  // namespace

namespace {

void check_adaptation(const Scene& scene) {
  if (!scene.adaptation.enabled) return;
  if (scene.particle.shape.imported)
    throw UserError("Adaptation/enabled and Particle/shape `file` contradict each other: a spline space from a file has no mesh to refine.");
  // The side of a square that is one element's share of the sphere of equal volume.
  const double area = 4 * std::numbers::pi * scene.radius() * scene.radius();
  scene.adaptation.check(static_cast<int>(scene.surface.n_points()), std::sqrt(area / scene.surface.n_elements()));
}

}  // namespace

void Scene::check() const {
  flow.check();
  check_tube(*this);
  particle.shape.check();
  surface.check();
  check_motion(*this);
  if (!particle.rigid()) membrane.check();
  time.check();
  if (adaptation.enabled && !lands_on_snapshots())
    throw UserError("Output/between steps `interpolate` and Adaptation/enabled contradict each other: the mesh may change between two steps.");
  modulus();
  if (volume.constraint == "none" && membrane.load == "weak" && membrane.load_measure == "reference")
    throw UserError(
        "Volume/constraint `none` and Membrane/load measure `reference` contradict each other: "
        "the load per reference area (3.7) needs `flux` or `exact`.");
  if (quadrature.rule == "desingularised" && surface.polar() && surface.poles == "plain")
    throw UserError("Quadrature/rule `desingularised` and Surface/poles `plain` contradict each other: a degenerate element has no normal "
                    "at its pole.");
  if (interface_motion() != "material" && membrane.law != "surface tension")
    throw UserError("Interface/motion `" + interface_motion() + "` and Membrane/law `" + membrane.law +
                    "` contradict each other: an elastic membrane moves with the fluid, `material`.");
  if (particle.drift == "held" && (tube.present || particle.rigid()))
    throw UserError("Particle/drift `held` and " + std::string(tube.present ? "Tube" : "Particle/motion `" + particle.motion + "`") +
                    " contradict each other: it is for particles that deform in a flow whose gradient is the same everywhere.");
  check_adaptation(*this);
  check_size(*this);
}

std::string Scene::interface_motion() const {
  return interface.motion.value_or(membrane.law == "surface tension" ? "relaxed" : "material");
}

double Scene::radius() const { return particle.shape.equivalent_radius(); }

double Scene::speed() const { return flow.speed(radius()); }

double Scene::modulus() const {
  if (particle.rigid()) return 0;
  return tube.present ? membrane.modulus(flow.viscosity, speed(), 1.0) : membrane.modulus(flow.viscosity, flow.rate(), radius());
}

bool Scene::reciprocal_forces() const { return particle.forces ? *particle.forces == "reciprocal" : quadrature.rule == "adaptive"; }

bool Scene::lands_on_snapshots() const {
  return output.between_steps ? *output.between_steps == "land" : !time.fixed_step || adaptation.enabled;
}

double Scene::snapshot_interval() const { return output.interval.value_or(time.final_time / 20.0); }

bool may_change_on_resume(const std::string& path) {
  if (path == "Tube/contact gap") return true;
  for (const char* fixed : {"Flow", "Particle", "Membrane", "Surface", "Volume", "Tube"})
    if (path.rfind(std::string(fixed) + "/", 0) == 0) return false;
  return true;
}

}  // namespace tanktread
