#include "record/numbers.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "base/formatted.hpp"
#include "membrane/strain_energy.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double resting_volume(const Body& body) { return surface::volume(body.space, body.rest); }
double resting_area(const Body& body) { return surface::measures(body.space, body.rest).area; }

constexpr Number named_numbers[] = {
    {"radius", "length", "R_C: radius of the sphere with the particle's volume", [](const ParticleScene&, const Body& b) { return b.radius; }},
    {"volume", "length^3", "volume of the resting shape", [](const ParticleScene&, const Body& b) { return resting_volume(b); }},
    {"area", "length^2", "area of the resting shape", [](const ParticleScene&, const Body& b) { return resting_area(b); }},
    {"reduced_volume", "1", "reduced volume 6 sqrt(pi) V/A^(3/2), with volume V and area A of the resting shape; 1 for a sphere",
     [](const ParticleScene&, const Body& b) { return 6 * std::sqrt(std::numbers::pi) * resting_volume(b) / std::pow(resting_area(b), 1.5); }},
    {"speed", "length/time", "velocity scale of the capillary number: rate of the flow times R_C; in a tube the mean velocity",
     [](const ParticleScene& s, const Body&) { return s.speed() > 0 ? s.speed() : none; }},
    {"viscosity_ratio", "1", "lambda: viscosity of the inner fluid divided by the viscosity of the outer fluid",
     [](const ParticleScene& s, const Body&) { return s.particle.rigid() ? none : s.particle.viscosity_ratio; }},
    {"capillary_number", "1",
     "capillary number mu speed/G_s, with the outer viscosity mu and the surface shear modulus G_s; for a drop mu speed/sigma, with the "
     "surface tension sigma",
     [](const ParticleScene& s, const Body&) { return !s.particle.rigid() && s.speed() > 0 ? s.flow.viscosity * s.speed() / s.modulus() : none; }},
    {"shear_modulus", "force/length", "surface shear modulus G_s of the membrane",
     [](const ParticleScene& s, const Body&) { return s.elastic() ? s.modulus() : none; }},
    {"area_modulus", "force/length",
     "area modulus K_s of the membrane at small strains: (1 + 2 C) G_s for the laws `Skalak` and `Evans-Skalak` with Membrane/area "
     "dilatation C, 3 G_s for rubber",
     [](const ParticleScene& s, const Body& b) { return s.elastic() ? area_modulus(b.law) : none; }},
    {"surface_tension", "force/length", "surface tension sigma of the drop",
     [](const ParticleScene& s, const Body&) { return s.particle.rigid() || s.elastic() ? none : s.modulus(); }},
    {"bending_modulus", "force length", "bending modulus E_b of the membrane",
     [](const ParticleScene& s, const Body&) { return s.elastic() && s.bending_modulus() > 0 ? s.bending_modulus() : none; }},
    {"bending_number", "1", "bending number E_b/(G_s R_C^2)",
     [](const ParticleScene& s, const Body& b) {
       return s.elastic() && s.bending_modulus() > 0 ? s.bending_modulus() / (s.modulus() * b.radius * b.radius) : none;
     }},
    {"relaxation_time", "time", "relaxation time of the shape: mu R_C/G_s; for a drop mu R_C/sigma",
     [](const ParticleScene& s, const Body& b) { return s.particle.rigid() ? none : s.flow.viscosity * b.radius / s.modulus(); }},
    {"tube_radius", "length", "radius R_T of the circle with the area of the cross-section",
     [](const ParticleScene&, const Body& b) { return b.duct ? b.duct->radius() : none; }},
    {"tube_length", "length", "length of the computed part of the tube",
     [](const ParticleScene&, const Body& b) { return b.wall ? b.wall->length() : none; }},
    {"confinement", "1", "confinement R_C/R_T: radius of the sphere with the particle's volume divided by the tube radius",
     [](const ParticleScene&, const Body& b) { return b.duct ? b.radius / b.duct->radius() : none; }},
    {"flow_rate", "length^3/time", "flow rate of the empty tube",
     [](const ParticleScene& s, const Body& b) {
       return b.duct && s.flow.type == "duct" ? b.duct->mean_velocity() * std::numbers::pi * std::pow(b.duct->radius(), 2) : none;
     }},
    {"pressure_gradient", "force/length^3", "decrease of the pressure per length along the empty tube",
     [](const ParticleScene& s, const Body& b) { return b.duct && s.flow.type == "duct" ? b.duct->pressure_gradient() : none; }},
    {"reynolds_number", "1", "Reynolds number: always 0, because the fluids have no inertia",
     [](const ParticleScene&, const Body&) { return 0.0; }},
};

}  // namespace

std::span<const Number> all_numbers() { return named_numbers; }

output::Entries<double> numbers(const Scene& scene, const Body& body) {
  output::Entries<double> found;
  if (scene.particles.size() > 1 || scene.only_solids) return found;  // named_numbers are defined only if there is a single particle
  const ParticleScene only = scene.first();
  for (const Number& one : named_numbers)
    if (const double value = one.value(only, body); !std::isnan(value)) found.emplace_back(one.name, value);
  return found;
}

std::string numbers_text(const output::Entries<double>& numbers) {
  std::string text;
  for (const auto& [name, value] : numbers) text += (text.empty() ? "" : ", ") + name + formatted(" %.6g", value);
  return text;
}

}  // namespace tanktread
