#include "record/new_deck.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "deck/document.hpp"
#include "scene/scene.hpp"

namespace tanktread {

namespace {

/// Example deck: its title, and its sections as YAML.
struct Example {
  std::string_view name, title, sections;
};

constexpr std::array<Example, 6> examples{{
    {"capsule", "A capsule in simple shear.",
     "Flow: {type: simple shear, shear rate: 1.0, viscosity: 1.0}, Particle: {shape: sphere, radius: 1.0, viscosity ratio: 1.0}, "
     "Membrane: {law: neo-Hookean, capillary number: 0.3}, Surface: {elements per side: 6}, Time: {final time: 5.0}, Output: {interval: 0.5}"},
    {"drop", "A drop in uniaxial extension.",
     "Flow: {type: uniaxial extension, shear rate: 1.0}, Particle: {shape: sphere, radius: 1.0, viscosity ratio: 1.0}, "
     "Membrane: {law: surface tension, capillary number: 0.05}, Surface: {elements per side: 6}, Time: {final time: 5.0}, Output: {interval: 0.5}"},
    {"tube", "A capsule that is carried along a circular tube.",
     "Flow: {type: duct, mean velocity: 1.0, viscosity: 1.0}, Tube: {section: circle, radius: 1.0}, Particle: {shape: sphere, radius: 0.8}, "
     "Membrane: {law: neo-Hookean, shear modulus: 20.0, pre-inflation: 0.1}, Surface: {elements per side: 6}, "
     "Time: {final time: 6.0, steady tolerance: 2.0e-4}, Output: {interval: 0.5}"},
    {"red-cell", "A red cell in simple shear; lengths in micrometres, times in seconds, forces in piconewtons.",
     "Flow: {type: simple shear, shear rate: 40.0, viscosity: 0.022}, Particle: {shape: red cell, radius: 3.91, viscosity ratio: 0.27}, "
     "Membrane: {law: Skalak, shear modulus: 5.0, area dilatation: 10.0, bending modulus: 0.2, bending reference: flat}, "
     "Surface: {elements per side: 8}, Time: {final time: 0.1}, Output: {interval: 0.01}"},
    {"rigid", "A free rigid spheroid in simple shear.",
     "Flow: {type: simple shear}, Particle: {shape: spheroid, semi-axes: [1.0, 1.0, 2.0], motion: free}, Surface: {elements per side: 6}, "
     "Time: {final time: 20.0}, Output: {interval: 0.5}"},
    {"several", "Two capsules that meet in simple shear.",
     "Flow: {type: simple shear}, Particles: {defaults: {Membrane: {law: neo-Hookean, capillary number: 0.3}, Surface: {elements per side: 6}}, "
     "left: {center: [-3.0, 0.0, 0.5]}, right: {center: [3.0, 0.0, -0.5]}}, Time: {final time: 10.0}, Output: {interval: 0.5}"},
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
  deck::Document document = deck::read_text("Tanktread: {" + std::string(one.sections) + "}");
  document.declare(scene);
  return "# " + std::string(one.title) + " Every key: tanktread --reference\n" + document.commented();
}

}  // namespace tanktread
