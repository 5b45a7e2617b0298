// Keys of a particle: declarations, and rejections of combinations.

#include <stdexcept>

#include "base/errors.hpp"
#include "scene/posts.hpp"
#include "scene/scene.hpp"

namespace tanktread {

bool ParticleOptions::rigid() const {
  switch (motion) {
    case Motion::deforming: return false;
    case Motion::prescribed: return true;
    case Motion::free: return true;
  }
  throw std::logic_error("this Motion is neither that of a rigid body nor of a deforming particle");
}

std::string text(Motion motion) { return "`" + deck::word(particle_motions, motion) + "`"; }

std::string ParticleOptions::choice() const { return "Particle/motion " + text(motion); }

void ParticleOptions::reject(const ParticleScene& particle_scene, Rejections& to) const {
  const bool prescribed = motion == Motion::prescribed, held = drift == "held", tube = particle_scene.tube.present;
  const Chosen moved = "Particle/motion `prescribed`", stiff(choice(), "Particle/motion `prescribed` or `free`");
  const Chosen duct = particle_scene.duct_choice();
  to.pair(!particle_scene.runs_in_time() && prescribed, particle_scene.sought(), moved, reason::prescribed);
  to.pair(particle_scene.tube.repulsion && prescribed, {particle_scene.tube.list() + "/repulsion", "Tube/repulsion"}, moved, reason::prescribed);
  to.pair(density_difference && prescribed, "Particle/density difference", moved, reason::prescribed);
  to.pair(prescribed && particle_scene.name.empty() && particle_scene.time.steady_tolerance, "Time/steady tolerance", moved,
          "a single body with prescribed motion has no shape or rotation that could become steady");
  for (const auto& [key, given] : {std::pair("Particle/velocity", velocity.has_value()), {"Particle/angular velocity", angular_velocity.has_value()}})
    to.pair(given && !prescribed, key, {choice(), "Particle/motion `deforming` or `free`"}, "it belongs to `prescribed`");
  for (const auto& [key, given] : {std::pair("Particle/force", force.has_value()), {"Particle/torque", torque.has_value()}}) {
    to.pair(given && prescribed, key, moved, reason::prescribed);
    to.pair(given && !rigid(), key, "Particle/motion `deforming`",
            "it is for `free`; for a deformable particle give a force per volume, by Particle/density difference and Flow/gravity");
  }
  to.pair(forces && !prescribed, "Particle/forces", {choice(), "Particle/motion `deforming` or `free`"},
          "it is the method for the force on a body with prescribed motion");
  to.pair(forces && prescribed && particle_scene.in_system() && particle_scene.runs_in_time() && !particle_scene.tube.repulsion, "Particle/forces",
          {std::string(why_in_system(particle_scene, particle_scene)),
           "Particles, Domain, Output/power balance, Output/series, Flow/history or Flow/type of an added flow"},
          "the force on a body in the coupled system follows from the solution of this system");
  to.pair(rigid() && particle_scene.membrane_given, "Membrane", stiff, reason::rigid);
  to.pair(rigid() && particle_scene.volume_given, "Volume", stiff, reason::rigid);
  to.pair(rigid() && viscosity_ratio != 1, "Particle/viscosity ratio", stiff, reason::rigid);
  to.pair(rigid() && shape.initial, "Particle/initial shape", stiff, reason::rigid);
  const auto& added_flow = particle_scene.flow.user;
  const bool bends = particle_scene.flow.type == "parabolic" || (added_flow && !added_flow->affine());
  to.pair(held && bends, "Particle/drift `held`", particle_scene.flow_choice(), reason::drift);
  to.pair(held && (tube || rigid()), "Particle/drift `held`",
          {tube ? duct.here : stiff.here, "Tube, Channel, or Particle/motion `prescribed` or `free`"}, reason::drift);
  to.pair(particle_scene.solvers.projection != "collocation" && (tube || particle_scene.wall.present || rigid()),
          "Solvers/projection `least squares`",
          {tube ? duct.here : particle_scene.wall.present ? "Wall" : stiff.here,
           "Tube, Channel, Wall, or Particle/motion `prescribed` or `free`"},
          "it is for deformable particles away from walls");
}

void ParticleOptions::declare(deck::Section& section) {
  shape.declare(section);
  section.key("viscosity ratio", viscosity_ratio, deck::positive(), "1",
              "lambda: viscosity of the fluid inside the particle divided by the viscosity of the outer fluid, at most 1e14 x "
              "Solvers/tolerance. Above 1e4, Time/scheme `bs3` takes fewer steps than implicit schemes. Above 1e5 the particle hardly "
              "deforms; for a rigid particle use Particle/motion `free`");
  section.key("motion", motion, particle_motions,
              "motion of the particle. `deforming`: its surface moves with the velocity of the fluid. `prescribed`: it is rigid and moves "
              "with Particle/velocity and Particle/angular velocity; for a single particle, the flow and the force are computed once, without time "
              "steps. `free`: it is rigid and moves such that Particle/force and Particle/torque, zero by default, balance the forces of the "
              "fluid");
  section.key("velocity", velocity, deck::any(), "length/time",
              "velocity of the centre of a rigid particle with Particle/motion `prescribed`; zero if not given");
  section.key("angular velocity", angular_velocity, deck::any(), "radian/time",
              "angular velocity about the centre of a rigid particle with Particle/motion `prescribed`; zero if not given");
  section.key("force", force, deck::any(), "force",
              "external force on a rigid particle with Particle/motion `free`, three numbers; zero if not given");
  section.key("torque", torque, deck::any(), "force x length",
              "external torque on a rigid particle with Particle/motion `free`, about the centre of its volume; zero if not given");
  section.key("density difference", density_difference, deck::any(), "force/(length^3 x Flow/gravity)",
              "density of the particle minus density of the outer fluid, for a particle that sediments or rises: multiplied by "
              "Flow/gravity it is the force per unit volume; zero if not given");
  section.key(
      "drift", drift, deck::Choice{"free", "held"},
      "treatment of the motion of the particle's centroid. `free`: it moves with the flow. `held`: it is moved back to its initial "
      "position after every step, which does not change the shape in a flow with a uniform gradient. The default is `held` for a "
      "particle without net force and registered loads at the stagnation point of a flow that diverges in some direction, where rounding "
      "errors would grow into a drift, and `free` otherwise");
  section.key("forces", forces, deck::Choice{"reciprocal", "integral"},
              "method of computing force and torque on a single particle with Particle/motion `prescribed`. `integral`: integral of the "
              "traction, as by Maestre et al. (2017). `reciprocal`: this integral corrected by the reciprocal theorem, which is more "
              "accurate; default with Quadrature/rule `adaptive`, the only rule that is accurate enough for it");
  if (shape.shape == "cylinder") section.without_effect_except("shape", only_keys_of_post);  // take_posts() allows some of the keys
}

void ParticleKind::declare(deck::Section& section, const Registry& registry) {
  section.mention("like");
  copies.present = section.given("copies");
  if (copies.present || section.documenting())
    section.section("copies", copies,
                    "copies of the particle: at positions from a file, on a lattice, or at random without overlap. An initial shape from a file "
                    "or run is moved and turned with each copy");
  else
    section.mention("copies");
  if (section.documenting()) return;
  particle.declare(section);
  declare_sections(section, registry);
}

void ParticleKind::declare_sections(deck::Section& section, const Registry& registry) {
  surface.of_cylinder = particle.shape.shape == "cylinder";
  surface.fits_tightly = particle.rigid() && particle.shape.sized() && particle.shape.equivalent_radius() > 0.75 * duct_half_width;
  const bool deforms = !particle.rigid() && !surface.of_cylinder;
  // removes the sections that come from sections shared by several particles and that this particle cannot have, because it ignores them
  if (!deforms) section.leave_out("Membrane");
  if (surface.of_cylinder) section.leave_out("Interface"), section.leave_out("Adaptation");
  membrane_given = section.given("Membrane");
  const auto of_membrane = [&](deck::Section& inner) {
    membrane.declare(inner);
    loads = registry.loads.read(inner, "loads", "loads that this program adds to the loads of the library; none without this section");
  };
  if (deforms || membrane_given) section.section("Membrane", of_membrane, "mechanical properties of the particle's membrane or interface");
  if (particle.shape.shape != "file") section.section("Surface", surface, "spline space and mesh of the particle's surface");
  else
    refuse(section.given("Surface"), section.path("Surface"), (name.empty() ? "Particle/shape" : section.path("shape")) + " `file`",
           unread::two_meshes);
  const auto of_interface = [&](deck::Section& inner) {
    interface.declare(inner);
    if (surface.of_cylinder) inner.without_effect_except("", only_keys_of_post);
    membrane::SurfactantOptions given;
    if (inner.optional_section("surfactant", given,
                               "an insoluble surfactant on the interface of a drop; without this section the interface is clean"))
      surfactant = given;
    fields = registry.fields.read(inner, "fields", "fields on the interface or membrane that this program adds; none without this section");
  };
  section.section("Interface", of_interface, "the interface of a drop: motion of the mesh along the interface, and surfactant");
  if (!section.documenting() && particle.shape.sized()) adaptation.radius = particle.shape.equivalent_radius();
  complete_film_resolution(false);  // before the section is read, so that the deck's values contain the default
  const auto of_adaptation = [&](deck::Section& inner) {
    adaptation.declare(inner);  // without `enabled`, also states that the other keys have no effect
    if (surface.of_cylinder && adaptation.enabled) inner.without_effect_except("", only_keys_of_post);
  };
  section.section("Adaptation", of_adaptation, "refinement and coarsening of the particle's surface mesh");
}

void ParticleKind::complete_film_resolution(bool films) {
  const bool several = !name.empty();
  if ((several || films) && !adaptation.film_resolution)
    adaptation.film_resolution = several && particle.rigid() ? 0.5 : motion::AdaptationOptions::default_film_resolution;
}

void ParticleKind::reject(const ParticleScene& particle_scene, Rejections& to) const {
  const bool drop = membrane.fluid_interface(), strong = particle_scene.load_is_strong(), rigid = particle.rigid();
  const bool desingularised = particle_scene.quadrature.rule == quadrature::LayerRule::desingularised;
  const bool degenerate = !surface.has_normal_at_poles();
  const bool constrained = particle_scene.volume.constrained();
  const std::string plain = "Surface/poles `plain`";
  const Chosen law("Membrane/law `" + membrane.law + "`", "Membrane/law of an elastic membrane");
  to.pair(adaptation.enabled && particle.shape.imported, "Adaptation/enabled", "Particle/shape `file`",
          "a spline space from a file has no mesh to refine");
  to.pair(particle_scene.accuracy.present && particle.shape.imported, "Accuracy", "Particle/shape `file`",
          "the mesh of a file is not refined, so that its error cannot be estimated");
  to.pair(!constrained && !strong && membrane.load_measure == "reference", "Volume/constraint `none`",
          "Membrane/load measure `reference`", "the load per reference area (3.7) needs `flux` or `exact`");
  to.pair(desingularised && degenerate, "Quadrature/rule `desingularised`", plain, reason::desingularised);
  to.pair(!drop && particle_scene.interface_motion() != coupling::MeshMotion::material,
          {"Interface/motion `" + deck::word(coupling::mesh_motions, particle_scene.interface_motion()) + "`",
           "Interface/motion other than `material`"},
          law, reason::interface);
  to.pair(surfactant && (rigid || !drop), "Interface/surfactant",
          {rigid ? particle.choice() : law.here, "Particle/motion `prescribed` or `free`, or Membrane/law of an elastic membrane"},
          reason::interface);
  const bool pieces = surface.replaces_elements();
  to.pair(adaptation.enabled && pieces && (surfactant || particle_scene.maxwell_membrane() || !fields.empty() || particle_scene.contact.limiter),
          "Adaptation/enabled with fields on surfaces or Contact/limiter", "Surface/poles `bezier transform`",
          "the elements at these poles are not those of the mesh that adapts; give `c1`");
  const surface::TubeOptions& tube = particle_scene.tube;
  const std::pair<bool, Chosen> weak[] = {  // choices that need loads by virtual work
      {membrane.bending(1, 1) > 0, {std::string("Membrane/bending ") + (membrane.bending_number ? "number" : "modulus"),
                                    "Membrane/bending modulus or bending number"}},
      {membrane.area_order > 0, "Membrane/area points"},
      {membrane.global_area_dilatation > 0, "Membrane/global area dilatation"},
      {membrane.viscosity.any(), {std::string("Membrane/") + (membrane.viscosity.shear > 0 ? "shear" : "dilatational") + " viscosity",
                                  "Membrane/shear viscosity or dilatational viscosity"}},
      {!membrane.forces.all.empty(), "Membrane/forces"},
      {!loads.empty(), "Membrane/loads"},
      {!drop && degenerate, plain},
      {surfactant.has_value(), "Interface/surfactant"},
      {!fields.empty(), "Interface/fields"},
      {particle_scene.contact.limiter, "Contact/limiter"},
      {particle.density_difference.has_value(), "Particle/density difference"},
      {tube.repulsion.has_value(), {tube.list() + "/repulsion", "Tube/repulsion"}}};
  for (const auto& [with, what] : weak) to.pair(with && strong, what, "Membrane/load `strong`", reason::strong);
}

}  // namespace tanktread
