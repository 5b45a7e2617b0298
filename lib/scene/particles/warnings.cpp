#include "scene/particles/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "accuracy/obstacles.hpp"
#include "base/formatted.hpp"
#include "membrane/strain_energy.hpp"
#include "scene/series/diagnostics.hpp"

namespace tanktread {

namespace {

// growth of waves on a compressed membrane, in e-folds, above which the user is warned; the waves soon become visible
constexpr double grown = 5;
// number of consecutive steps limited by stability after which the user is warned; a few such steps can occur at the start
constexpr int limited_steps = 10;
constexpr double folding = 0.05;    // warning threshold of jacobian_ratio, which is at least 0.5 on uniform elements and 0.1 at a degenerate pole
constexpr double slenderness = 10;  // threshold of aspect_ratio
// threshold of surface::Quality::tilt, radians: two elements across a rounded tip. Lengths err by up to 4 % above it, by at most 1 % below it
constexpr double sharpness = 0.7;
constexpr double lost_volume = 1e-3;
// threshold of K/G_s and K R_C^2/E_b, with the modulus K of the total area. If both are above it, time steps become very small
constexpr double stiff_area = 3e4;
// thresholds of locking(): errors of 1 % of the length of a red cell pulled by tweezers (6 elements per side); tensions that oscillate between points
constexpr double locked = 20, oscillating = 5;

/// Returns the largest wave number that a mesh of element size h can represent.
double wave_number(double h) { return std::numbers::pi / h; }

/// Returns the mean of the viscosities of the inner and the outer fluid.
double mean_viscosity(const ParticleScene& particle_scene) {
  return particle_scene.flow.viscosity * (1 + particle_scene.particle.viscosity_ratio) / 2;
}

/// Returns the area dilatation C, for which area modulus / shear modulus = 1 + 2 C, of a membrane whose area is resisted at all points of an element,
/// so that the mesh locks if C is large. Returns 0 if the area is resisted at one point per element, for a drop and for a rigid body.
double locking(const ParticleScene& particle_scene) {
  if (!particle_scene.elastic()) return 0;
  const membrane::Options& given = particle_scene.membrane;
  if (const auto own = given.strain_energy()) return (own->area_modulus() / own->shear_modulus() - 1) / 2;
  return given.area_order == 1 ? 0 : given.area_dilatation.value_or(0);
}

/// Returns the advice to the user for a membrane whose mesh locks, as a part of a sentence.
std::string area_points(const ParticleScene& particle_scene) {
  return std::string("set Membrane/area points to 1") + (particle_scene.membrane.dilates() ? "" : ", with Membrane/law Skalak or Evans-Skalak");
}

/// Returns the advice to the user for elements that are too coarse, as a part of a sentence.
std::string finer_mesh(const ParticleScene& particle_scene) {
  return particle_scene.adaptation.enabled ? "set a finer mesh, or smaller limits in Adaptation" : "set a finer mesh, or Adaptation/enabled";
}

/// Returns the worst mesh quality over all ranks, from the quality `mine` of this rank's elements.
surface::Quality worst(const surface::Quality& mine, const coupling::Ranks& ranks) {
  const std::array<double, 8> own{mine.jacobian_ratio,  double(mine.folded_element), mine.folded_place[0], mine.folded_place[1],
                                  mine.folded_place[2], mine.aspect_ratio,           double(mine.stretched_element), mine.tilt};
  surface::Quality result;
  for (const auto& [jacobian, folded, x1, x2, x3, aspect, stretched, tilt] : ranks.gathered(own))
    result = surface::worse(result, {jacobian, static_cast<int>(folded), {x1, x2, x3}, aspect, static_cast<int>(stretched), tilt});
  return result;
}

/// Returns the warnings about choices of the deck for a deforming particle.
std::vector<Warning> choices(const ParticleScene& one) {
  std::vector<Warning> found;
  const auto add = [&found](bool applies, const char* kind, const std::string& sentence) {
    if (applies) found.push_back({kind, sentence});
  };
  const membrane::Options& given = one.membrane;
  add(one.elastic() && given.load == "strong", "strong load",
      "the load is computed in the strong form, which amplifies errors of the shape until the time step vanishes: set Membrane/load to weak");
  add(!one.surface.has_normal_at_poles() && one.quadrature.rule == quadrature::LayerRule::fixed, "poles",
      "a fixed Gauss rule does not converge on elements of plain poles: set Surface/poles to bezier transform, or Quadrature/rule to adaptive");
  const double k = given.global_area_dilatation;
  add(!one.particle.rigid() && k > stiff_area && k * one.modulus() > stiff_area * one.bending_modulus() / (one.radius() * one.radius()), "total area",
      "the total area is so stiff that many time steps are needed: a Membrane/global area dilatation of 1e4 conserves it nearly as well");
  add(locking(one) >= locked, "locking",
      formatted("the mesh locks, because the area, with a modulus of %.3g G_s, is resisted at all points of an element: many steps are needed, and "
                "lengths can err by several per cent; ",
                1 + 2 * locking(one)) +
          area_points(one));
  add(!one.particle.rigid() && given.fluid_interface() && k > 0 && one.flow.type != "quiescent", "vesicle",
      "only the total area of a vesicle is kept, not that of each part: this is exact at rest, but in shear the inclination is 2 to 4 degrees too "
      "small (reduced volume 0.9); set Membrane/law to Skalak, Membrane/capillary number (instead of Membrane/surface tension) to 5, Membrane/area "
      "dilatation to 1000 and Membrane/area points to 1");
  return found;
}

}  // namespace

double stiffness(const ParticleScene& particle_scene, double h) {
  const double k = wave_number(h), g = particle_scene.modulus(), mu = mean_viscosity(particle_scene);
  const double in_plane = std::max(1 + particle_scene.membrane.area_dilatation.value_or(1), 1.0) * g * k / (2 * mu);
  return std::max(in_plane, particle_scene.bending_modulus() * k * k * k / (4 * mu));
}

StepFindings::StepFindings(const ParticleScene& particle_scene, const Columns& row, const surface::Quality& quality, int n_elements)
    : time(row.value("time")),
      step(row.value("time_step")),
      smallest_tension(row.of_particles("smallest_tension")),
      compressed_area(row.of_particles("compressed_area")),
      volume_error(std::max(row.largest("volume_error"), -row.smallest("volume_error"))),
      jacobian_ratio(quality.jacobian_ratio),
      aspect_ratio(quality.aspect_ratio),
      tilt(quality.tilt) {
  if (particle_scene.tube.present || (particle_scene.wall.present && !particle_scene.adaptation.enabled)) gap = row.value("gap");
  const std::vector<double> areas = row.of_particles("area");
  element = std::sqrt(std::accumulate(areas.begin(), areas.end(), 0.) / n_elements);
}

std::vector<Warning> first_warnings(const Scene& scene) {
  std::vector<Warning> found;
  for (const ParticleScene& one : scene.particle_scenes())
    for (const Warning& choice : choices(one))
      if (std::ranges::find(found, choice.kind, &Warning::kind) == found.end()) found.push_back(choice);
  const auto forgets = [](const ParticleScene& one) {
    return one.particle.shape.initial && one.particle.shape.initial->run && (one.surfactant || one.maxwell_membrane() || !one.fields.empty());
  };
  if (std::ranges::any_of(scene.particle_scenes(), forgets))
    found.push_back({"fields", "surfactant and other surface fields start as in a new run: Particle/initial shape/run gives the shape only"});
  if (scene.tube.images)
    found.push_back({"images", "Tube/images has no effect, because a periodic tube has all its images: remove the key."});
  const double interval = scene.snapshot_interval(), step = scene.time.fixed_step.value_or(0);
  if (scene.runs_in_time() && scene.output.interval && !scene.lands_on_snapshots() && step > interval * (1 + 1e-9))
    found.push_back(
        {"snapshots", formatted("Time/fixed step %g is longer than Output/interval %g: each step has at most one snapshot", step, interval)});
  return found;
}

Warnings::Warnings(const Scene& scene) : deforming_(scene.particle_scenes()), scene_(scene.first_deforming()) {
  std::erase_if(deforming_, [](const ParticleScene& one) { return one.particle.rigid(); });
}

bool Warnings::fresh(const Warning& warning) {
  if (std::ranges::find(memory_.shown, warning.kind, &Warning::kind) != memory_.shown.end()) return false;
  memory_.shown.push_back(warning);
  return true;
}

std::vector<Warning> Warnings::of_step(const StepFindings& signs) {
  std::vector<Warning> all;
  const auto add = [&](const char* kind, const std::string& sentence) {
    const Warning warning{kind, formatted("at time %.4g ", signs.time) + sentence};
    if (!sentence.empty() && fresh(warning)) all.push_back(warning);
  };
  add(accuracy::wrinkles, compression(signs));
  add("stiffness", stiffness(signs));
  add("fold", fold(signs));
  add("stretch", stretch(signs));
  add("tip", tip(signs));
  add("gap", gap(signs));
  add("volume", volume(signs));
  return all;
}

/// Returns a warning when waves on a compressed membrane have grown. On a flat membrane under the tension -T with bending modulus B, waves of wave
/// number k grow at the rate (T k - B k^3)/(4 mu), fastest at k = sqrt(T/(3 B)). On capsules they grow at six tenths of this rate. The rate of the
/// flow is subtracted from the growth rate, because the flow carries waves out of the compressed region. Of several membranes, the one with the
/// fastest growth counts.
std::string Warnings::compression(const StepFindings& signs) {
  const double mesh = wave_number(signs.element);
  double fastest_growth = 0;
  std::optional<std::size_t> worst;  // index of the particle with the fastest growth
  for (std::size_t p = 0; p < std::min(deforming_.size(), signs.smallest_tension.size()); ++p) {
    const ParticleScene& one = deforming_[p];
    if (!one.elastic()) continue;
    const double tension = std::max(0.0, -signs.smallest_tension[p]) * one.modulus(), bending = one.bending_modulus();
    const double fastest = bending > 0 ? std::sqrt(tension / (3 * bending)) : mesh, k = std::min(fastest, mesh);
    const bool resolved = fastest < mesh / 2;  // the warning is about waves that the mesh does not resolve; resolved waves are physical
    const double growth = (resolved ? 0 : 0.6 * (tension * k - bending * k * k * k) / (4 * mean_viscosity(one))) - one.rate();
    if (!worst || growth > fastest_growth) fastest_growth = growth, worst = p;
  }
  if (!worst) return {};
  memory_.waves = std::max(0.0, memory_.waves + fastest_growth * signs.step);
  if (memory_.waves < grown) return {};
  const ParticleScene& one = deforming_[*worst];
  const bool bends = one.bending_modulus() > 0;
  const std::string cure = locking(one) >= oscillating ? area_points(one) + ", because its mesh locks"
                           : bends ? finer_mesh(one) + "; a higher Membrane/bending modulus or Membrane/pre-inflation changes the membrane"
                                   : "set Membrane/bending modulus or Membrane/pre-inflation";
  return formatted("%.0f %% of the membrane is compressed (to %.2g G_s) with %s: waves as short as its elements can have grown a hundredfold; ",
                   100 * signs.compressed_area.at(*worst), signs.smallest_tension[*worst],
                   bends ? "too little resistance to bending for its mesh" : "no resistance to bending") +
         cure;
}

std::string Warnings::stiffness(const StepFindings& signs) {
  const bool fixed = scene_.time.fixed_step.has_value(), explicit_scheme = scene_.time.scheme == "bs3";
  const bool iterated = scene_.time.scheme == "crank-nicolson" && scene_.time.nonlinear_solver == "plain";
  double stiffest = 0;
  for (const ParticleScene& one : deforming_)
    if (one.elastic()) stiffest = std::max(stiffest, tanktread::stiffness(one, signs.element));
  if (stiffest == 0 || !(explicit_scheme || iterated)) return {};
  const double limit = explicit_scheme ? 2.51 : 2, reached = signs.step * stiffest;
  memory_.limited = reached > 0.8 * limit ? memory_.limited + 1 : 0;
  if (!(fixed && reached > limit) && memory_.limited < limited_steps) return {};
  const char* what = explicit_scheme ? "explicit step" : "sub-iterated step";
  return formatted("the %s times the membrane's stiffness is %.2g, and the limit is about %.2g: %s; set Time/scheme to auto", what, reached,
                   limit, fixed ? "the run may blow up" : "steps are short for stability, not for Time/tolerance");
}

std::string Warnings::fold(const StepFindings& signs) const {
  if (signs.jacobian_ratio > folding) return {};
  const std::string cure = scene_.membrane.load == "strong" && scene_.elastic()           ? "set Membrane/load to weak"
                           : scene_.interface_motion() == coupling::MeshMotion::material && !scene_.elastic() ? "set Interface/motion to relaxed"
                                                                                         : finer_mesh(scene_);
  const bool drawn = !scene_.elastic() && has_intrinsic_viscosity(scene_);
  return formatted("an element is about to fold (smallest Jacobian %.2g of the mean): ", signs.jacobian_ratio) + cure +
         (drawn ? "; or there is no steady shape: above a critical capillary number the flow stretches the drop until it breaks" : "");
}

std::string Warnings::stretch(const StepFindings& signs) const {
  if (signs.aspect_ratio < slenderness) return {};
  return formatted("an element is %.0f times as long as wide: ", signs.aspect_ratio) +
         (scene_.elastic() || scene_.interface_motion() == coupling::MeshMotion::relaxed ? "" : "set Interface/motion to relaxed, or ") +
         finer_mesh(scene_);
}

std::string Warnings::tip(const StepFindings& signs) const {
  if (signs.tilt < sharpness) return {};
  return formatted("the surface turns by %.0f degrees within an element, so that lengths and tractions there depend on the mesh: ",
                   360 / std::numbers::pi * signs.tilt) +
         finer_mesh(scene_);
}

std::string Warnings::gap(const StepFindings& signs) const {
  if (!signs.gap || *signs.gap > signs.element / 2) return {};
  return formatted("the gap to the wall (%.2g) is less than half an element (%.2g): ", *signs.gap, signs.element) +
         (!scene_.tube.present           ? finer_mesh(scene_)
          : scene_.adaptation.enabled ? "set a finer mesh of the tube, and of the particle smaller limits in Adaptation"
                                      : "set finer meshes of particle and tube, or Adaptation/enabled");
}

std::string Warnings::volume(const StepFindings& signs) const {
  if (scene_.particle.rigid() || std::abs(signs.volume_error) < lost_volume) return {};
  return formatted("a fraction %.2g of the volume is lost: set Volume/constraint to exact, or a lower Time/tolerance", signs.volume_error);
}

surface::Quality soundness(const surface::BezierMap& map, const Net& x, const coupling::Ranks& ranks) {
  const surface::Quality quality = worst(surface::quality(map, x, ranks.share(map.n_elements())), ranks);
  surface::require_sound(quality);
  return quality;
}

}  // namespace tanktread
