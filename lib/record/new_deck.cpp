#include "record/new_deck.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "deck/document.hpp"
#include "scene/scene.hpp"

namespace tanktread {

namespace {

/// Example deck: its title, and its sections besides Units as YAML.
struct Example {
  std::string_view name, title, sections;
};

constexpr std::array<Example, 6> examples{{
    {"capsule", "A capsule in simple shear.",
     "Flow: {type: simple shear, shear rate: 100 1/s, viscosity: 30 mPa s}, Particle: {shape: sphere, radius: 50 um, viscosity ratio: 1.0}, "
     "Membrane: {law: neo-Hookean, shear modulus: 0.5 mN/m}, Surface: {elements per side: 6}, Time: {final time: 50 ms}, Output: {interval: 5 ms}"},
    {"drop", "A drop in uniaxial extension.",
     "Flow: {type: uniaxial extension, shear rate: 100 1/s, viscosity: 10 mPa s}, Particle: {shape: sphere, radius: 50 um, viscosity ratio: 1.0}, "
     "Membrane: {law: surface tension, surface tension: 1 mN/m}, Surface: {elements per side: 6}, Time: {final time: 50 ms}, "
     "Output: {interval: 5 ms}"},
    {"tube", "A capsule that is carried along a circular tube.",
     "Flow: {type: duct, mean velocity: 5 mm/s, viscosity: 10 mPa s}, Tube: {section: circle, radius: 50 um}, "
     "Particle: {shape: sphere, radius: 40 um}, Membrane: {law: neo-Hookean, shear modulus: 1 mN/m, pre-inflation: 0.1}, "
     "Surface: {elements per side: 6}, Time: {final time: 60 ms, steady tolerance: 2.0e-4}, Output: {interval: 5 ms}"},
    {"red-cell", "A red cell in simple shear.",
     "Flow: {type: simple shear, shear rate: 40 1/s, viscosity: 22 mPa s}, Particle: {shape: red cell, radius: 3.91 um, viscosity ratio: 0.27}, "
     "Membrane: {law: Skalak, shear modulus: 5 uN/m, area dilatation: 10.0, bending modulus: 2e-19 J}, "
     "Surface: {elements per side: 8}, Time: {final time: 100 ms}, Output: {interval: 10 ms}"},
    {"rigid", "A free rigid spheroid in simple shear.",
     "Flow: {type: simple shear, shear rate: 10 1/s, viscosity: 1 mPa s}, "
     "Particle: {shape: spheroid, semi-axes: [1 um, 1 um, 2 um], motion: free}, Surface: {elements per side: 6}, "
     "Time: {final time: 2 s}, Output: {interval: 50 ms}"},
    {"several", "Two capsules that meet in simple shear.",
     "Flow: {type: simple shear, shear rate: 100 1/s, viscosity: 30 mPa s}, Particles: {"
     "defaults: {radius: 50 um, Membrane: {law: neo-Hookean, shear modulus: 0.5 mN/m}, Surface: {elements per side: 6}}, "
     "left: {center: [-150 um, 0 um, 25 um]}, right: {center: [150 um, 0 um, -25 um]}}, Time: {final time: 100 ms}, Output: {interval: 5 ms}"},
}};

}  // namespace

std::vector<std::string> kinds_of_decks() {
  std::vector<std::string> names;
  for (const Example& one : examples) names.emplace_back(one.name);
  return names;
}

std::string new_deck(const std::string& kind) {
  const Example& one = *std::ranges::find(examples, kind, &Example::name);
  Scene scene;
  deck::Document document = deck::read_text("Tanktread: {Units: {}, " + std::string(one.sections) + "}");
  document.declare(scene);
  return "# " + std::string(one.title) + " Every key: tanktread --reference\n" + document.commented();
}

}  // namespace tanktread
