#include "record/numbers.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "base/formatted.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double resting_volume(const Body& body) { return surface::volume(body.space, body.rest); }
double resting_area(const Body& body) { return surface::measures(body.space, body.rest).area; }

constexpr Number named_numbers[] = {
    {"radius", "length", "R_C: of the sphere of equal volume", [](const Scene&, const Body& b) { return b.radius; }},
    {"volume", "length^3", "of the resting shape", [](const Scene&, const Body& b) { return resting_volume(b); }},
    {"area", "length^2", "of the resting shape", [](const Scene&, const Body& b) { return resting_area(b); }},
    {"reduced_volume", "1", "6 sqrt(pi) V/A^(3/2): 1 of a sphere",
     [](const Scene&, const Body& b) { return 6 * std::sqrt(std::numbers::pi) * resting_volume(b) / std::pow(resting_area(b), 1.5); }},
    {"speed", "length/time", "of Ca: rate of the flow times R_C; in a tube the mean velocity",
     [](const Scene& s, const Body&) { return s.speed() > 0 ? s.speed() : none; }},
    {"viscosity_ratio", "1", "lambda: viscosity inside over viscosity outside",
     [](const Scene& s, const Body&) { return s.particle.rigid() ? none : s.particle.viscosity_ratio; }},
    {"capillary_number", "1", "Ca = mu speed/G_s, of a drop mu speed/sigma",
     [](const Scene& s, const Body&) { return !s.particle.rigid() && s.speed() > 0 ? s.flow.viscosity * s.speed() / s.modulus() : none; }},
    {"shear_modulus", "force/length", "G_s", [](const Scene& s, const Body&) { return s.elastic() ? s.modulus() : none; }},
    {"area_modulus", "force/length", "K_s of small strains: (1 + 2 C) G_s of Skalak's law and of Evans and Skalak's, 3 G_s of rubber",
     [](const Scene& s, const Body& b) { return s.elastic() ? area_modulus(b.law) : none; }},
    {"surface_tension", "force/length", "sigma",
     [](const Scene& s, const Body&) { return s.particle.rigid() || s.elastic() ? none : s.modulus(); }},
    {"bending_modulus", "force length", "E_b",
     [](const Scene& s, const Body&) { return s.elastic() && s.bending_modulus() > 0 ? s.bending_modulus() : none; }},
    {"bending_number", "1", "E_b/(G_s R_C^2)",
     [](const Scene& s, const Body& b) {
       return s.elastic() && s.bending_modulus() > 0 ? s.bending_modulus() / (s.modulus() * b.radius * b.radius) : none;
     }},
    {"relaxation_time", "time", "mu R_C/G_s, of a drop mu R_C/sigma",
     [](const Scene& s, const Body& b) { return s.particle.rigid() ? none : s.flow.viscosity * b.radius / s.modulus(); }},
    {"tube_radius", "length", "R_T: of the circle of equal area",
     [](const Scene&, const Body& b) { return b.duct ? b.duct->radius() : none; }},
    {"tube_length", "length", "of the piece of the tube that is computed",
     [](const Scene&, const Body& b) { return b.wall ? b.wall->length() : none; }},
    {"confinement", "1", "R_C/R_T", [](const Scene&, const Body& b) { return b.duct ? b.radius / b.duct->radius() : none; }},
    {"flow_rate", "length^3/time", "Q of the empty tube",
     [](const Scene& s, const Body& b) {
       return b.duct && s.flow.type == "duct" ? b.duct->mean_velocity() * std::numbers::pi * std::pow(b.duct->radius(), 2) : none;
     }},
    {"pressure_gradient", "force/length^3", "fall of the pressure along the empty tube",
     [](const Scene& s, const Body& b) { return b.duct && s.flow.type == "duct" ? b.duct->pressure_gradient() : none; }},
    {"reynolds_number", "1", "0: the fluids have no inertia, whatever their density", [](const Scene&, const Body&) { return 0.0; }},
};

}  // namespace

std::span<const Number> all_numbers() { return named_numbers; }

output::Entries<double> numbers(const Scene& scene, const Body& body) {
  output::Entries<double> found;
  if (!scene.particles.empty()) return found;  // which are of one particle
  for (const Number& one : named_numbers)
    if (const double value = one.value(scene, body); !std::isnan(value)) found.emplace_back(one.name, value);
  return found;
}

std::string numbers_text(const output::Entries<double>& numbers) {
  std::string text;
  for (const auto& [name, value] : numbers) text += (text.empty() ? "" : ", ") + name + formatted(" %.6g", value);
  return text;
}

}  // namespace tanktread
