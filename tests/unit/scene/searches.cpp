// Tests of the rigid motions that the search for a steady shape leaves free, for one particle and for several.

#include <string>

#include <gtest/gtest.h>

#include "deck/document.hpp"
#include "refusal.hpp"
#include "scene/body.hpp"
#include "scene/member.hpp"
#include "scene/searches/searches.hpp"

namespace tanktread {
namespace {

Scene scene_of(const std::string& lists) {
  Scene scene;
  deck::Document document = deck::read({}, {"Time/final time=1"}, "Tanktread:\n" + lists);
  document.declare(scene);
  scene.check();
  return scene;
}

/// Returns the message with which the deck is refused; empty if it is valid.
std::string refusal(const std::string& lists) {
  return refusal_of([&] { scene_of(lists); });
}

std::size_t free_number(const std::string& lists) {
  const Scene scene = scene_of(lists);
  std::vector<std::unique_ptr<Body>> bodies;
  std::vector<coupling::Particle> particles;
  for (const ParticleScene& one : scene.particle_scenes()) {
    bodies.push_back(std::make_unique<Body>(make_body(one)));
    particles.emplace_back().loads = make_loads(one, *bodies.back(), nullptr).all();
    if (one.particle.rigid()) particles.back().rigid = drive_of(one, *bodies.back());
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

// The free motions are the translations and the rotation about the common direction of force and torque.
TEST(FreeMotions, ExcludeRotationsOfForcesAndTorquesOnRigidBodies) {
  const auto number = [](const std::string& flow, const std::string& keys) {
    return free_number(flow + "  Particle: {motion: free, " + keys + "}\n  Steady: {}\n");
  };
  EXPECT_EQ(number(still_fluid, "shape: sphere"), 6u);
  EXPECT_EQ(number(still_fluid, "torque: [0, 0, 1]"), 4u);
  EXPECT_EQ(number(still_fluid, "torque: [0, 0, 1], force: [0, 0, -2]"), 4u);
  EXPECT_EQ(number(still_fluid, "torque: [0, 0, 1], force: [1, 0, 0]"), 3u);
  EXPECT_EQ(number(with_gravity, "density difference: 1"), 4u);
}

/// Returns a deck that searches for a periodic motion and rotates the shape by `turn` about x2 after a period.
std::string half_turn(const std::string& flow, const std::string& particle, const std::string& more = "", const std::string& turn = "180") {
  return flow + "  Particle: {motion: free, shape: ellipsoid, semi-axes: [2, 1, 0.4]" + particle + "}\n" + more + "  Periodic: {period: 3, turn: " +
         turn + "}\n";
}

const std::string why = " contradict each other: the rotation about x2 must not change flow, walls, forces and torques; give 0.";

TEST(Turns, OfPeriodicMotionsMustNotChangeForces) {
  const std::string shear = "  Flow: {type: simple shear, gravity: [0.3, 0, -1]}\n", along = "  Flow: {type: simple shear, gravity: [0, -1, 0]}\n";
  EXPECT_EQ(refusal(half_turn(shear, ", density difference: 1")), "Periodic/turn and Particle/density difference" + why);
  EXPECT_EQ(refusal(half_turn(shear, ", density difference: 1", "", "0")), "");
  EXPECT_EQ(refusal(half_turn(shear, ", density difference: 1", "", "360")), "");
  EXPECT_EQ(refusal(half_turn(along, ", density difference: 1")), "");
  EXPECT_EQ(refusal(half_turn(still_fluid, ", force: [0, 1, 0], torque: [0, 2, 0]")), "");
  EXPECT_EQ(refusal(half_turn(still_fluid, ", force: [1, 0, 0]")), "Periodic/turn and Particle/force" + why);
  EXPECT_EQ(refusal(half_turn(still_fluid, ", torque: [0, 1, 1]")), "Periodic/turn and Particle/torque" + why);
  EXPECT_EQ(refusal("  Flow: {type: simple shear}\n" + one_particle("", pulled) + "  Periodic: {period: 3, turn: 180}\n"),
            "Periodic/turn and Membrane/forces" + why);
}

TEST(Turns, OfPeriodicMotionsMustNotChangeFlowAndWalls) {
  const std::string shear = "  Flow: {type: simple shear}\n", plates = "  Wall: {point: [0, 0, -3], distance: 6}\n";
  const auto box = [](const std::string& along) { return "  Domain: {periodic: " + along + ", side lengths: [8, 8, 8]}\n"; };
  EXPECT_EQ(refusal(half_turn(shear, "")), "");
  EXPECT_EQ(refusal(half_turn(shear, "", "", "90")), "Periodic/turn and Flow/type `simple shear`" + why);
  EXPECT_EQ(refusal(half_turn("  Flow: {type: parabolic, half width: 5}\n", "")), "Periodic/turn and Flow/type `parabolic`" + why);
  EXPECT_EQ(refusal(half_turn("  Flow: {type: parabolic, half width: 5}\n", "", "", "0")), "");
  EXPECT_EQ(refusal(half_turn(shear, "", plates + box("x1 x2"))), "");
  EXPECT_EQ(refusal(half_turn(shear, "", "  Wall: {point: [0, 0, -3], distance: 8}\n" + box("x1 x2"))), "Periodic/turn and Wall" + why);
  EXPECT_EQ(refusal(half_turn(still_fluid, "", box("x1 x2"))), "");
  EXPECT_EQ(refusal(half_turn(still_fluid, "", box("x1 x2"), "90")), "Periodic/turn and Domain" + why);
  EXPECT_EQ(refusal(half_turn(still_fluid, "", "  Tube: {radius: 3}\n")), "Periodic/turn and Tube" + why);
}

TEST(SteadyShapes, OfElasticParticlesThatATorqueTurnsAreRejected) {
  const std::string turned = "shape: ellipsoid, semi-axes: [2, 1, 0.4], torque: [0, 0, 1]", sentence = "Steady and Particle/torque contradict";
  EXPECT_NE(refusal(still_fluid + one_particle(turned, capsule) + "  Steady: {}\n").find(sentence), std::string::npos);
  EXPECT_EQ(refusal(still_fluid + "  Particle: {motion: free, " + turned + "}\n  Steady: {}\n"), "");
}

// Only the rotation about the axis is free, because an extensional flow is at rest only at its centre.
TEST(FreeMotions, InAnExtensionAreTheRotationAboutItsAxis) { EXPECT_EQ(free_number("  Flow: {type: uniaxial extension}\n"), 1u); }

}  // namespace
}  // namespace tanktread
