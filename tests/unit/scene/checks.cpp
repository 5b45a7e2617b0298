// Tests of checks that concern several sections of a deck: names of particles, keys of posts, loads of several particles.

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/document.hpp"
#include "deck/section.hpp"
#include "scene/scene.hpp"
#include "refusal.hpp"

namespace tanktread {
namespace checks_test {

Scene scene(const std::string& sections) {
  Scene out;
  deck::Document document = deck::read({}, {"Time/final time=1"}, "Tanktread:\n" + sections);
  document.declare(out);
  out.check();
  return out;
}

/// Returns the message with which the deck is refused; empty if it is valid.
std::string refusal(const std::string& sections) {
  return refusal_of([&] { scene(sections); });
}

/// Returns the section of a particle that deforms.
std::string capsule(const std::string& name, double x1, const std::string& keys = "") {
  return formatted("    %s: {center: [%g, 0, 0], Membrane: {shear modulus: 1%s}, Surface: {elements per side: 3}}\n", name.c_str(), x1, keys.c_str());
}

const std::string cell = "  Flow: {type: quiescent, pressure gradient: [-1, 0, 0]}\n  Domain: {side lengths: [6, 6, 6]}\n";

/// Returns the section of a post with more keys.
std::string post(const std::string& name, const std::string& keys = "") {
  return "    " + name + ": {shape: cylinder, axis: x3, radius: 0.5, center: [3, 3, 0]" + keys + "}\n";
}

TEST(Names, OfParticlesAndPostsAreNoSeriesOfTheRun) {
  const std::string taken = " has the name of a series of the run: give it another name.";
  EXPECT_EQ(refusal("  Particles:\n" + capsule("a", 0) + capsule("time", 4)), "Particles/time" + taken);
  EXPECT_EQ(refusal(cell + "  Particles:\n" + capsule("a", 0) + post("time")), "Particles/time" + taken);
  EXPECT_EQ(refusal(cell + "  Particles:\n" + post("permeability")), "Particles/permeability" + taken);
  EXPECT_EQ(refusal(cell + "  Particles:\n" + capsule("a", 0) + post("b")), "");
  const std::string branch = "  Flow: {type: planar hyperbolic}\n  Steady: {}\n  Continuation: {parameter: Flow/shear rate, to: 2}\n  Particles:\n";
  EXPECT_EQ(refusal(branch + capsule("fold", 0)), "Particles/fold" + taken);
  EXPECT_EQ(refusal(branch + capsule("period", 0)), "");
  EXPECT_EQ(refusal("  Particles:\n" + capsule("fold", 0)), "");
}

TEST(Names, OfCopiesOfFilesAreNoFilesOfTheResults) {
  Scene named = scene("  Particles:\n" + capsule("surface", 0));
  EXPECT_NO_THROW(named.check());
  named.files.emplace_back("drop.iga", "surface.iga");
  EXPECT_THROW(named.check(), UserError);
  named.files.back().second = "drop.iga";
  EXPECT_NO_THROW(named.check());
}

TEST(Posts, RefuseKeysOfOtherParticles) {
  const auto refused = [](const std::string& keys) { return refusal(cell + "  Particles:\n" + post("post", ", " + keys)); };
  const std::string only = " has no effect on a post (Particle/shape `cylinder`), which has only the keys radius, axis and center, and the keys "
                           "azimuthal elements and axial elements of Surface: remove the key.";
  EXPECT_EQ(refused("viscosity ratio: 2"), "Particles/post/viscosity ratio" + only);
  EXPECT_EQ(refused("motion: free"), "Particles/post/motion" + only);
  EXPECT_EQ(refused("orientation: [0, 90, 0]"), "Particles/post/orientation" + only);
  EXPECT_EQ(refused("Interface: {relaxation: 2}"), "Particles/post/Interface/relaxation" + only);
  EXPECT_EQ(refused("Interface: {motion: normal}"), "Particles/post/Interface/motion" + only);
  EXPECT_EQ(refused("Adaptation: {enabled: true}"), "Particles/post/Adaptation/enabled" + only);
  const std::string fixed = " and Particle/shape `cylinder` contradict each other: a cylinder is a fixed post, which does not move or deform.";
  EXPECT_EQ(refused("Interface: {surfactant: {elasticity number: 0.2}}"), "Particles/post/Interface/surfactant" + fixed);
  EXPECT_EQ(refused("Membrane: {shear modulus: 1}"), "Particles/post/Membrane" + fixed);
  EXPECT_EQ(refused("initial shape: {stretch: [1, 1, 2]}"), "Particles/post/initial shape" + fixed);
  EXPECT_EQ(refusal(cell + "  Particle: {shape: cylinder, axis: x3}\n  Interface: {relaxation: 2}\n"), "Interface/relaxation" + only);
  EXPECT_EQ(refusal(cell + "  Particle: {shape: cylinder, axis: x3, velocity: [1, 0, 0]}\n"), "Particle/velocity" + only);
  EXPECT_EQ(refusal(cell + "  Particle: {shape: cylinder, axis: x3}\n  Membrane: {shear modulus: 1}\n"), "Membrane" + fixed);
}

TEST(Posts, IgnoreSectionsSharedWithOtherParticles) {
  const std::string defaults = "    defaults: {Membrane: {shear modulus: 1}, Interface: {relaxation: 2}, Adaptation: {enabled: true}, "
                               "Surface: {elements per side: 3}}\n";
  const Scene shared = scene(cell + "  Particles:\n" + defaults + "    a: {center: [0, 0, 0]}\n" + post("post"));
  ASSERT_EQ(shared.posts.size(), 1u);
  EXPECT_EQ(shared.posts.front().radius, 0.5);
  ASSERT_EQ(shared.idle_keys.size(), 1u);  // Surface/elements per side of the post: a warning
  EXPECT_EQ(shared.idle_keys.front().find("Particles/post/Surface/elements per side has no effect"), 0u);
  EXPECT_EQ(scene(cell + "  Particles:\n" + post("post") + "    other: {like: post, center: [0, 0, 0]}\n").posts.size(), 2u);
}

TEST(Posts, AreReproducedFromTheirEffectiveDeck) {
  const std::string alone = "  Particle: {shape: cylinder, axis: x2, radius: 0.4}\n", with = "  Particles:\n" + capsule("a", 0) + post("post");
  for (const std::string& particles : {alone, with}) {
    Scene first, second;
    deck::Document once = deck::read({}, {"Time/final time=1"}, "Tanktread:\n" + cell + particles);
    once.declare(first);
    deck::Document twice = deck::read_text(once.effective());
    twice.declare(second);
    EXPECT_EQ(once.effective(), twice.effective());
    EXPECT_EQ(second.posts.front().radius, first.posts.front().radius);
    EXPECT_TRUE(second.idle_keys.empty());
  }
}

TEST(Loads, AreComparedAmongDeformingParticlesOnly) {
  const std::string start = "  Volume: {constraint: flux}\n  Particles:\n", strong = ", load: strong";
  const std::string body = "    body: {motion: free, center: [8, 0, 0], Surface: {elements per side: 3}}\n";
  EXPECT_EQ(refusal(start + capsule("a", 0, strong) + body), "");
  EXPECT_EQ(refusal(start + body + capsule("a", 0, strong)), "");
  EXPECT_EQ(refusal(start + body + capsule("a", 0, strong) + capsule("b", 4)),
            "Particles/b/Membrane/load must be the same for all deforming particles.");
  EXPECT_NE(refusal(start + body + capsule("a", 0, strong) + "  Output: {power balance: true}\n"), "");
}

TEST(NetForces, NeedALatticeOfThreeDirections) {
  const auto refused = [](const std::string& keys) {
    return refusal("  Flow: {type: quiescent, gravity: [0, 0, -1]}\n  Domain: {periodic: x1, side lengths: [6, 6, 6]}\n  Particle: {" + keys +
                   "}\n  Membrane: {shear modulus: 1}\n");
  };
  EXPECT_EQ(refused("density difference: 1"), "Domain/periodic `x1` and Particle/density difference contradict each other: a net force in every cell "
                                              "needs a lattice that is periodic in three directions, or walls.");
  EXPECT_EQ(refused("density difference: 0"), "");
}

TEST(Rejections, OfSectionsThatCannotBeReadTogetherAreInTheTable) {
  const std::string table = rejection_table(no_parts);
  for (const char* row : {"| Channel | Tube |", "| Tube/periodic length | Domain |", "| Flow/pressure gradient | Flow/type `parabolic` |",
                          "| Surface | Particle/shape `file` |"})
    EXPECT_NE(table.find(row), std::string::npos) << row;
}

TEST(Scenes, GiveAllParticlesTheLeastRadius) {
  const Scene all = scene("  Particles:\n" + capsule("a", 0) + "    small: {radius: 0.5, center: [4, 0, 0], Surface: {elements per side: 3}}\n");
  for (const ParticleScene& one : all.particle_scenes()) EXPECT_EQ(one.least_radius, 0.5) << one.name;
  EXPECT_EQ(all.first().least_radius, 0.5);
}

}  // namespace checks_test
}  // namespace tanktread
