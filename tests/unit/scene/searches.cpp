// Tests of the rigid motions that the search for a steady shape leaves free, for one particle and for several.

#include <string>

#include <gtest/gtest.h>

#include "deck/document.hpp"
#include "scene/body.hpp"
#include "scene/searches/searches.hpp"

namespace tanktread {
namespace {

std::size_t free_number(const std::string& lists) {
  Scene scene;
  deck::Document document = deck::read({}, {"Time/final time=1"}, "Tanktread:\n" + lists);
  document.declare(scene);
  scene.check();
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<coupling::Particle> particles;
  for (const ParticleScene& one : scene.particle_scenes()) {
    bodies.push_back(std::make_unique<Body>(make_body(one)));
    particles.emplace_back().loads = make_loads(one, *bodies.back(), nullptr).all();
  }
  return free_motions(scene, stokes::AmbientFlow(scene.flow), 1, particles).size();
}

const std::string still_fluid = "  Flow: {type: quiescent}\n", with_gravity = "  Flow: {type: quiescent, gravity: [0, 0, -1]}\n",
                  capsule = "Membrane: {shear modulus: 1}",
                  pulled = "Membrane: {shear modulus: 1, forces: {tip: {direction: [1, 0, 0], radius: 0.5, force: [1, 0, 0]}, "
                           "tail: {direction: [-1, 0, 0], radius: 0.5, force: [-1, 0, 0]}}}";

std::string one_particle(const std::string& particle, const std::string& membrane) { return "  Particle: {" + particle + "}\n  " + membrane + "\n"; }

std::string with_a_second(const std::string& particle, const std::string& membrane) {
  return "  Particles:\n    light: {center: [3, 0, 0], " + capsule + "}\n    other: {center: [0, 0, 0], " + particle + ", " + membrane + "}\n";
}

TEST(FreeMotions, InAFluidAtRestAreAllRigidMotions) { EXPECT_EQ(free_number(still_fluid + one_particle("", capsule)), 6u); }

// The free motions are the translations and the rotation about the force.
TEST(FreeMotions, ExcludeRotationsOfAWeightExceptAboutItsDirection) {
  EXPECT_EQ(free_number(with_gravity + one_particle("density difference: 1", capsule)), 4u);
  EXPECT_EQ(free_number(with_gravity + with_a_second("density difference: 1", capsule)), 4u);
}

TEST(FreeMotions, ExcludeRotationsOfForcesOnPatches) {
  EXPECT_EQ(free_number(still_fluid + one_particle("", pulled)), 4u);
  EXPECT_EQ(free_number(still_fluid + with_a_second("shape: sphere", pulled)), 4u);
}

// Only the rotation about the axis is free, because an extensional flow is at rest only at its centre.
TEST(FreeMotions, InAnExtensionAreTheRotationAboutItsAxis) { EXPECT_EQ(free_number("  Flow: {type: uniaxial extension}\n"), 1u); }

}  // namespace
}  // namespace tanktread
