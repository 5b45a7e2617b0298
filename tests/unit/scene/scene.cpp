#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/document.hpp"
#include "deck/section.hpp"
#include "scene/member.hpp"
#include "scene/particles/gaps.hpp"
#include "scene/particles/particle_system.hpp"
#include "system/parallel/ranks.hpp"
#include "refusal.hpp"

namespace tanktread {
namespace scene_test {

Scene scene(const std::string& lists) {
  Scene out;
  deck::Document document = deck::read({}, {"Time/final time=1"}, "Tanktread:\n" + (lists.empty() ? "  Flow: {}\n" : lists));
  document.declare(out);
  out.check();
  return out;
}

ParticleScene only(const std::string& lists) { return scene(lists).first(); }

std::string refusal(const std::string& lists) {
  return refusal_of([&] { scene(lists); });
}

TEST(Scenes, DefaultToASphereInShear) {
  const ParticleScene s = only("");
  EXPECT_EQ(s.flow.type, "simple shear");
  EXPECT_EQ(s.radius(), 1.0);
  EXPECT_NEAR(s.modulus(), 1 / 0.3, 1e-15);
  EXPECT_EQ(s.membrane.law, "neo-Hookean");
  EXPECT_EQ(s.volume.constraint, coupling::VolumeConservation::exact);
  EXPECT_EQ(s.time.scheme, "tr-bdf2");
  EXPECT_EQ(s.snapshot_interval(), s.time.final_time / 20);
}

TEST(Scenes, AreReproducedFromTheirEffectiveDeck) {
  for (const char* lists :
       {"  Flow: {type: quiescent}\n  Membrane: {shear modulus: 2}\n", "  Membrane: {law: Skalak, capillary number: 0.1}\n",
        "  Flow: {type: linear, gradient: [1, 0, 0, 0, -1, 0, 0, 0, 0]}\n", "  Particle: {shape: ellipsoid, semi-axes: [1, 2, 3]}\n",
        "  Flow: {type: four-roll, roll parameter: 0.6}\n  Membrane: {law: surface tension}\n", "  Surface: {mesh: polar}\n",
        "  Surface: {mesh: polar, azimuthal elements: 8, pole axis: x2, poles: c1}\n", "  Time: {fixed step: 0.01, scheme: bs3}\n",
        "  Flow: {type: parabolic, half width: 3}\n  Membrane: {bending number: 0.01}\n",
        "  Flow: {history: {times: [0, 1.5, 1.5], amplitudes: [1, 1, 0], angles: [0, 30, 30]}}\n",
        "  Flow: {history: {type: sine, frequency: 2}}\n"}) {
    Scene first, second;
    deck::Document once = deck::read({}, {"Time/final time=1"}, std::string("Tanktread:\n") + lists);
    once.declare(first);
    first.check();
    deck::Document twice = deck::read_text(once.effective());
    twice.declare(second);
    second.check();
    EXPECT_EQ(once.effective(), twice.effective());
    EXPECT_EQ(first.first().modulus(), second.first().modulus());
  }
}

TEST(Scenes, RejectViscosityRatiosThatRoundingMakesUnsolvable) {
  EXPECT_EQ(refusal("  Particle: {viscosity ratio: 1e6}\n"), "");
  EXPECT_NE(refusal("  Particle: {viscosity ratio: 1.1e6}\n"), "");
  EXPECT_EQ(refusal("  Particle: {viscosity ratio: 1e9}\n  Solvers: {tolerance: 1e-5}\n"), "");
}

TEST(Scenes, CountTheFactorsOfTheWallOnEveryRank) {
  const std::string tube = "  Flow: {type: duct}\n  Particle: {}\n  Tube: {azimuthal elements: 100, axial elements: ";
  const bool one_rank = coupling::Ranks().size() == 1;
  EXPECT_EQ(refusal(tube + "240}\n").empty(), one_rank);                        // 43 GB per rank
  EXPECT_NE(refusal(tube + "300}\n").find("more than the limit of 64 GB"), std::string::npos);  // 66 GB per rank
}

TEST(Scenes, ScaleLengthsOfRefinementWithTheirSize) {
  const ParticleScene one = only("  Adaptation: {enabled: true}\n"), other = only("  Particle: {radius: 1.0e-6}\n  Adaptation: {enabled: true}\n");
  EXPECT_DOUBLE_EQ(other.adaptation.surface_tolerance, 1e-6 * one.adaptation.surface_tolerance);
  EXPECT_DOUBLE_EQ(other.adaptation.minimum_length, 1e-6 * one.adaptation.minimum_length);
  EXPECT_DOUBLE_EQ(other.adaptation.coarsening_tolerance, 1e-6 * one.adaptation.coarsening_tolerance);
  EXPECT_EQ(only("  Particle: {radius: 2}\n  Adaptation: {enabled: true, surface tolerance: 0.5}\n").adaptation.surface_tolerance, 0.5);
}

TEST(Scenes, RejectTooManySnapshots) {
  EXPECT_NE(refusal("  Time: {final time: 2}\n  Output: {interval: 1.0e-9}\n").find("Output/interval"), std::string::npos);
}

TEST(Moduli, FollowFromTheCapillaryNumber) {
  EXPECT_DOUBLE_EQ(only("  Flow: {viscosity: 2, shear rate: 3}\n  Particle: {radius: 4}\n  Membrane: {capillary number: 0.5}\n").modulus(),
                   48.0);
  EXPECT_DOUBLE_EQ(only("  Membrane: {shear modulus: 7}\n").modulus(), 7.0);
  // For shear, the largest singular value of the gradient is the shear rate; for hyperbolic flow it is the rate of that flow.
  EXPECT_DOUBLE_EQ(scene("  Flow: {type: linear, gradient: [0, 0, 2.5, 0, 0, 0, 0, 0, 0]}\n").flow.rate(), 2.5);
  EXPECT_DOUBLE_EQ(scene("  Flow: {type: linear, gradient: [2, 0, 0, 0, 0, 0, 0, 0, -2]}\n").flow.rate(), 2.0);
}

TEST(Moduli, FollowFromTheRateOfAParabolicFlowAndFromTheBendingNumber) {
  const ParticleScene s = only("  Flow: {type: parabolic, half width: 8, maximum velocity: 2}\n  Particle: {radius: 4}\n"
                        "  Membrane: {capillary number: 0.5, bending number: 0.1}\n");
  EXPECT_DOUBLE_EQ(s.modulus(), 2);            // the rate 2/8 times the radius divided by Ca
  EXPECT_DOUBLE_EQ(s.bending_modulus(), 3.2);  // 0.1 G_s R_C^2
}

TEST(EquivalentRadii, AreThoseOfTheSphereOfEqualVolume) {
  EXPECT_DOUBLE_EQ(only("  Particle: {shape: ellipsoid, semi-axes: [1, 2, 4]}\n").radius(), 2.0);
  EXPECT_DOUBLE_EQ(only("  Particle: {shape: spheroid, semi-axes: [8, 8, 1]}\n").radius(), 4.0);
  // Volume of the disc by the midpoint rule: outline z = (R/2) sqrt(1 - r^2)(0.21 + 2.0 r^2 - 1.12 r^4).
  double volume = 0;
  const int steps = 200000;
  for (int i = 0; i < steps; ++i) {
    const double r = (i + 0.5) / steps;
    volume += 2 * std::numbers::pi * r * std::sqrt(1 - r * r) * (0.21 + 2.0 * r * r - 1.12 * std::pow(r, 4)) / steps;
  }
  EXPECT_NEAR(only("  Particle: {shape: red cell, radius: 2}\n").radius(), 2 * std::cbrt(volume * 3 / (4 * std::numbers::pi)),
              1e-6);  // error of the midpoint rule
}

TEST(Orientations, RotateTheAxesOfTheParticle) {
  const ParticleScene s = only("  Particle: {shape: spheroid, semi-axes: [2, 2, 1], orientation: [0, -45, 0]}\n");
  EXPECT_TRUE(s.particle.shape.rotation().col(0).isApprox(Vec3(1, 0, 1).normalized(), 1e-15)) << "along the direction of extension";
  EXPECT_TRUE(only("").particle.shape.rotation().isIdentity(0));
}

TEST(Contradictions, OfFlowsAreReportedInOneSentenceEach) {
  EXPECT_EQ(refusal("  Flow: {type: parabolic}\n"), "Flow/type `parabolic` needs Flow/half width.");
  EXPECT_EQ(refusal("  Flow: {half width: 2}\n"), "Flow/half width belongs to Flow/type `parabolic`, but Flow/type is `simple shear`.");
  EXPECT_EQ(refusal("  Flow: {type: parabolic, half width: 2, shear rate: 3}\n"),
            "Flow/shear rate and Flow/type `parabolic` contradict each other: give Flow/maximum velocity.");
  EXPECT_EQ(refusal("  Flow: {type: parabolic, half width: 2}\n  Particle: {drift: held}\n"),
            "Particle/drift `held` and Flow/type `parabolic` contradict each other: it is for a particle that deforms in unbounded fluid, in a flow "
            "whose gradient is uniform.");
  EXPECT_EQ(refusal("  Flow: {history: {times: [0, 1]}}\n"),
            "Flow/history/type `table` needs Flow/history/amplitudes or Flow/history/angles.");
  EXPECT_EQ(refusal("  Flow: {history: {amplitudes: [0, 1]}}\n"), "Flow/history/type `table` needs Flow/history/times or Flow/history/file.");
  EXPECT_EQ(refusal("  Flow: {history: {times: [0, 2, 1], amplitudes: [0, 1, 2]}}\n"),
            "Flow/history/times must be in ascending order.");
  EXPECT_EQ(refusal("  Flow: {history: {times: [0, 2], amplitudes: [0, 1, 2]}}\n"),
            "Flow/history/amplitudes must hold as many numbers as Flow/history/times, 2, but holds 3.");
  EXPECT_EQ(refusal("  Flow: {history: {times: [-1, 2], amplitudes: [0, 1]}}\n").find("Flow/history/times must be one number or more"), 0u);
  EXPECT_EQ(refusal("  Flow: {history: {type: sine}}\n"), "Flow/history/type `sine` needs Flow/history/frequency.");
  EXPECT_EQ(refusal("  Flow: {history: {type: sine, frequency: 1, times: [1]}}\n"),
            "Flow/history/times belongs to the type `table`, but is given with Flow/history/type `sine`.");
  EXPECT_EQ(refusal("  Flow: {history: {type: sine, frequency: 1}}\n  Particle: {motion: prescribed}\n"), "");
  EXPECT_EQ(refusal("  Flow: {type: quiescent, history: {type: sine, frequency: 1}}\n  Membrane: {shear modulus: 1}\n"),
            "Flow/history and Flow/type `quiescent` contradict each other: a fluid at rest has no flow that could vary in time.");
  EXPECT_EQ(refusal("  Membrane: {bending modulus: 0, bending number: 0.1}\n"),
            "Membrane/bending modulus and Membrane/bending number contradict each other: give one of them.");
}

TEST(Contradictions, AreReportedInOneSentenceEach) {
  EXPECT_EQ(refusal("  Membrane: {capillary number: 0.3, shear modulus: 1}\n"),
            "Membrane/capillary number and Membrane/shear modulus contradict each other: give one of them.");
  EXPECT_EQ(refusal("  Membrane: {area dilatation: 2}\n"),
            "Membrane/area dilatation belongs to Membrane/law `Skalak` and `Evans-Skalak`, but Membrane/law is `neo-Hookean`.");
  EXPECT_EQ(refusal("  Membrane: {surface tension: 2}\n"),
            "Membrane/surface tension and Membrane/law `neo-Hookean` contradict each other: give Membrane/shear modulus.");
  EXPECT_EQ(refusal("  Membrane: {law: surface tension, load measure: reference}\n"),
            "Membrane/law `surface tension` needs Membrane/load measure `current`: a fluid interface has no unstressed shape.");
  EXPECT_EQ(refusal("  Particle: {semi-axes: [1, 1, 2]}\n"),
            "Particle/semi-axes and Particle/shape `sphere` contradict each other: give Particle/radius.");
  EXPECT_EQ(refusal("  Particle: {shape: ellipsoid}\n"), "Particle/shape `ellipsoid` needs Particle/semi-axes, three lengths.");
  EXPECT_EQ(refusal("  Surface: {mesh: polar, elements per side: 6}\n"),
            "Surface/elements per side and Surface/mesh `polar` contradict each other: it belongs to `cube`.");
  EXPECT_EQ(refusal("  Surface: {poles: c1}\n"), "Surface/poles and Surface/mesh `cube` contradict each other: it belongs to `polar`.");
  EXPECT_EQ(refusal("  Surface: {mesh: polar, poles: plain, pole subdivisions: 1}\n"),
            "Surface/pole subdivisions and Surface/poles `plain` contradict each other: it belongs to `bezier transform`.");
  EXPECT_EQ(refusal("  Surface: {mesh: polar}\n  Adaptation: {enabled: true}\n"), "");
  EXPECT_EQ(refusal("  Surface: {mesh: polar, azimuthal elements: 8, meridional elements: 4}\n"
                    "  Adaptation: {enabled: true, minimum length: 0.7}\n"),
            "Adaptation/minimum length must be below the length of the initial elements, 0.627, so that elements can be refined, but is 0.7.");
  EXPECT_EQ(refusal("  Flow: {type: quiescent}\n"),
            "Membrane/capillary number needs a flow with a gradient: give Membrane/shear modulus instead.");
  EXPECT_EQ(refusal("  Flow: {type: four-roll}\n"), "Flow/type `four-roll` needs Flow/roll parameter.");
  EXPECT_EQ(refusal("  Flow: {roll parameter: 0.5}\n"),
            "Flow/roll parameter belongs to Flow/type `four-roll`, but Flow/type is `simple shear`.");
  EXPECT_EQ(refusal("  Time: {fixed step: 0.1, initial step: 0.1}\n"),
            "Time/fixed step and Time/initial step contradict each other: give one of them.");
  EXPECT_EQ(refusal("  Volume: {constraint: none}\n")
                .find("Volume/constraint `none` and Membrane/load measure `reference` contradict each other"),
            0u);
  EXPECT_EQ(refusal("  Volume: {constraint: none}\n  Membrane: {load measure: current}\n"), "");
}

TEST(Sizes, BeyondMemoryAreRejectedWithAnEstimate) {
  const std::string assembled = "  Solvers: {frozen operator: assembled}\n";
  EXPECT_EQ(refusal("  Surface: {elements per side: 100}\n"), "");  // only near-field matrices are stored
  EXPECT_EQ(refusal(assembled + "  Surface: {elements per side: 110}\n"), "");
  EXPECT_EQ(
      refusal(assembled + "  Surface: {elements per side: 120}\n"),
      "Surface/elements per side must be at most 110, but is 120: the assembled boundary-integral operators of 86402 control points take 90 GB, "
      "more than the limit of 64 GB.");
  EXPECT_EQ(refusal(assembled + "  Surface: {elements per side: 120}\n  Time: {scheme: bs3}\n"), "");
  EXPECT_EQ(
      refusal(assembled + "  Surface: {mesh: polar, azimuthal elements: 400, meridional elements: 200}\n"),
      "Surface/azimuthal elements and Surface/meridional elements must give at most 73029 control points: the assembled "
      "boundary-integral operators of 80402 control points take 78 GB, more than the limit of 64 GB.");
  const double factored = 72.0 * coupling::Ranks().size();  // every rank stores the factors
  const auto points = [](double side) { return 6 * side * side + 2; };
  double most = 3;
  while (factored * points(most + 1) * points(most + 1) <= 64e9) ++most;
  EXPECT_EQ(refusal("  Particle: {motion: free}\n  Surface: {elements per side: 80}\n"),
            formatted("Surface/elements per side must be at most %.0f, but is 80: the assembled boundary-integral operators of 38402 control points "
                      "take %.0f GB, more than the limit of 64 GB.",
                      most, factored * 38402. * 38402. / 1e9));
  EXPECT_EQ(refusal("  Flow: {type: duct}\n  Particle: {}\n  Tube: {azimuthal elements: 200, axial elements: 200}\n"),
            formatted("Tube/azimuthal elements and Tube/axial elements must give at most %.0f control points: the assembled "
                      "boundary-integral operators of 40600 control points take %.0f GB, more than the limit of 64 GB.",
                      std::floor(std::sqrt(64e9 / factored)), factored * 40600. * 40600. / 1e9));
  EXPECT_NE(refusal("  Surface: {elements per side: 1000000}\n").find("between 3 and 200"), std::string::npos);
}

/// Returns the section of a particle with its centre on the x1 axis and with additional subsections.
std::string particle(const std::string& name, double x1, const std::string& lists = "") {
  return formatted("    %s: {center: [%g, 0, 0], Surface: {elements per side: 3}%s}\n", name.c_str(), x1, lists.c_str());
}

TEST(Members, WithEqualMeshesShareTheirTables) {
  const Scene all = scene("  Particles:\n" + particle("first", 0) + particle("softer", 3, ", Membrane: {capillary number: 0.1}") +
                          particle("equal", 6.1) + particle("flatter", 9, ", shape: ellipsoid, semi-axes: [1, 1, 0.9]") + "  Contact: {}\n");
  std::vector<Member> members = make_members(all);
  arrange(members);
  ASSERT_EQ(members.size(), 4u);
  for (std::size_t p = 1; p < members.size(); ++p) EXPECT_EQ(members[p].geometry, members[0].geometry);
  EXPECT_EQ(members[2].membrane, members[0].membrane);
  EXPECT_NE(members[1].membrane, members[0].membrane);
  EXPECT_NE(members[3].membrane, members[0].membrane);
}

TEST(Members, HaveTheMeshAndTheShapeOfASingleParticle) {
  const std::string flat = ", shape: ellipsoid, semi-axes: [1, 1, 0.9]";
  const Scene all = scene("  Particles:\n" + particle("first", 0) + particle("turned", 3, ", orientation: [0, 40, 10]") + particle("flat", 6, flat) +
                          particle("flat and turned", 9, flat + ", orientation: [20, 0, 30]") + particle("large", 15, ", radius: 2") +
                          "    fine: {center: [20, 0, 0], Surface: {elements per side: 4}}\n  Contact: {}\n");
  for (const Member& member : make_members(all)) {
    const Body alone = make_body(member.scene);
    ASSERT_EQ(member.body->rest.rows(), alone.rest.rows()) << member.name;
    EXPECT_LT((member.body->rest - alone.rest).cwiseAbs().maxCoeff(), 1e-13) << member.name;
    EXPECT_EQ(member.body->space.n_points, alone.space.n_points) << member.name;
    EXPECT_NEAR(member.body->volume, alone.volume, 1e-12) << member.name;
  }
}

TEST(Members, HaveTheSymmetryOfASingleParticleWhetherTheyHaveANameOrNot) {
  const std::string around = "  Channel: {section: circle, radius: 1, profile: constriction, depth: 0.5, half length: 2}\n";
  const std::string place = "{radius: 0.4, center: [-2.6, 0, 0]}\n";
  const auto order = [&](const std::string& particle) {
    return make_members(scene("  Flow: {type: duct, mean velocity: 1}\n" + around + particle)).front().body->symmetry.order();
  };
  EXPECT_GT(order("  Particle: " + place), 1);
  EXPECT_EQ(order("  Particles: {a: " + place + "}\n"), order("  Particle: " + place));
}

/// Returns the deck of two rigid spheres of radius 1 on x1, the distance of whose centres is 2 + gap, with meshes of n x n elements on six sides.
std::string two_spheres(double gap, int n, const std::string& keys = "") {
  return formatted("  Flow: {type: quiescent}\n  Particles:\n    defaults: {motion: free, Surface: {elements per side: %d}%s}\n    one: {}\n"
                   "    two: {center: [%.9g, 0, 0]}\n",
                   n, keys.c_str(), 2 + gap);
}

/// Returns the message with which the start of the particles is refused; empty if they may start.
std::string refused_start(const std::string& sections) {
  return refusal_of([&] { checked_members(scene(sections)); });
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Starts, WhereOnlyTheMeshesOverlapAskForFinerMeshes) {
  const std::string coarse = "The meshes are too coarse: Particles/one and Particles/two overlap at the start, near [1";
  const std::string wide = "  Contact: {limit: 1e-5}\n";
  EXPECT_EQ(refused_start(two_spheres(-0.05, 4)).find("Particles/one and Particles/two overlap at the start, near ["), 0u);
  const std::string said = refused_start(two_spheres(1e-4, 4));
  EXPECT_TRUE(contains(said, coarse) && contains(said, "With 2 times as many elements") && contains(said, "Contact/limit")) << said;
  EXPECT_TRUE(contains(refused_start(two_spheres(1e-4, 4) + wide), coarse));
  EXPECT_EQ(refused_start(two_spheres(1e-4, 8) + wide), "");  // the remedy
  const std::string wall = "  Flow: {type: quiescent}\n  Wall: {contact gap: 1e-5}\n  Particle: {motion: free, center: [0, 0, 1.0001]";
  EXPECT_TRUE(contains(refused_start(wall + "}\n  Surface: {elements per side: 4}\n"), "The meshes are too coarse: The particle crosses the wall"));
  EXPECT_EQ(refused_start(wall + "}\n  Surface: {elements per side: 8}\n"), "");
}

TEST(Starts, BelowTheLimitOfContactsAreRefused) {
  const std::string close = "Particles/one and Particles/two start too close to each other: near [1";
  EXPECT_EQ(refused_start(two_spheres(5e-4, 8)).find(close), 0u);
  EXPECT_EQ(refused_start(two_spheres(2e-3, 8)), "");
  EXPECT_EQ(refused_start(two_spheres(5e-4, 8) + "  Contact: {limit: 4e-4}\n"), "");
  const std::string limited = "  Contact: {limit: 9e-4, limiter: true}\n";  // which moves them apart if the gap is at least half of the limit
  EXPECT_EQ(refused_start(two_spheres(5e-4, 8) + limited), "");
  EXPECT_EQ(refused_start(two_spheres(4e-4, 8) + limited).find(close), 0u);
  // The gap of the meshes is 2.4e-4 smaller. An adaptive mesh of a rigid body is refined before the first step.
  EXPECT_TRUE(contains(refused_start(two_spheres(1.1e-3, 4)), "The meshes are too coarse: " + close));
  EXPECT_EQ(refused_start(two_spheres(1.1e-3, 4, ", Adaptation: {enabled: true}")), "");
  EXPECT_EQ(refused_start(two_spheres(5e-4, 4, ", Adaptation: {enabled: true}")).find(close), 0u);
  const std::string image = refused_start("  Flow: {type: quiescent}\n  Domain: {side lengths: [2.0005, 4, 4]}\n  Particle: {motion: free}\n"
                                          "  Surface: {elements per side: 8}\n");
  EXPECT_TRUE(contains(image, "Particle and its own image start too close")) << image;
}

TEST(Evaluations, OfAParticleThatCrossesAnotherPartNameBoth) {
  const auto crossing = [](const std::string& sections, const Vec3& shift) {
    const Scene all = scene(sections);
    coupling::Ranks ranks;
    Phases phases;
    const auto particles = make_particle_system(all, ranks, phases);
    const coupling::State start = particles->start();
    particles->dynamics().set_time(0, 0);
    EXPECT_TRUE(particles->dynamics().velocity(start).allFinite());
    EXPECT_FALSE(particles->dynamics().velocity(start + moved(start, {shift})).allFinite());
    const std::string why = particles->dynamics().why_undefined();
    particles->dynamics().velocity(start);
    return why.substr(0, why.find(" near ["));
  };
  const std::string small = "{radius: 0.4, center: [-1, 0, 0], Membrane: {shear modulus: 1}, Surface: {elements per side: 3}}\n";
  const std::string cell = "  Flow: {type: quiescent}\n  Particles:\n    bead: " + small, box = "  Domain: {side lengths: [4, 4, 1.2]}\n";
  const std::string post = "    pillar: {shape: cylinder, axis: x3, radius: 0.3, Surface: {azimuthal elements: 8, axial elements: 8}}\n";
  const std::string tube = "  Flow: {type: duct}\n  Tube: {radius: 1, azimuthal elements: 8, axial elements: 8}\n  Particles:\n    bead: ";
  EXPECT_EQ(crossing(cell + post + box, {0.5, 0, 0}), "Particles/bead would cross Particles/pillar");
  EXPECT_EQ(crossing(cell + "  Wall: {point: [0, 0, -1]}\n", {0, 0, -0.8}), "Particles/bead would cross the wall");
  EXPECT_EQ(crossing(tube + small, {0, 0.8, 0}), "Particles/bead would cross the wall of the duct");
}

TEST(Scenes, WithWallsOrALatticeAskForTheirParticle) {
  const std::string still = "  Flow: {type: quiescent}\n", plates = "  Domain: {periodic: x1 x2, side lengths: [12, 12, 1]}\n";
  for (const auto& [around, name] : {std::pair<std::string, std::string>("  Flow: {type: duct}\n  Tube: {radius: 1}\n", "Tube"),
                                     {"  Flow: {type: duct}\n  Channel: {profile: constriction, depth: 0.5, half length: 2}\n", "Channel"},
                                     {still + "  Wall: {point: [0, 0, -6]}\n", "Wall"},
                                     {still + "  Wall: {point: [0, 0, -6], distance: 12}\n" + plates, "Wall"},
                                     {still + "  Domain: {side lengths: [6, 6, 6]}\n", "Domain"}}) {
    EXPECT_EQ(refusal(around).find(name + " needs a particle"), 0u) << around;
    EXPECT_EQ(refusal(around + "  Surface: {elements per side: 4}\n").find(name + " needs a particle"), 0u) << around;
    EXPECT_EQ(refusal(around + "  Particle: {motion: free, radius: 0.5}\n"), "") << around;
    EXPECT_EQ(refusal(around + "  Membrane: {shear modulus: 1}\n"), "") << around;
    EXPECT_EQ(refusal(around + "  Particles: {a: {motion: free}}\n"), "") << around;
  }
  EXPECT_EQ(refusal(still + "  Domain: {side lengths: [6, 6, 6]}\n  Particle: {shape: cylinder, axis: x1, radius: 1}\n"), "");
}

TEST(Scenes, PutASingleRigidBodyInAFlowOfAnyDegreeIntoTheSystem) {
  struct Keys {
    void declare(deck::Section&) {}
  };
  struct Cubic : stokes::UserFlow {
    Vec3 velocity(const Vec3& x) const override { return {x[2] * (x[2] * x[2] - 3 * x[1] * x[1]), 0, 0}; }
    Mat3 gradient(const Vec3& x) const override {
      Mat3 all = Mat3::Zero();
      all.row(0) << 0, -6 * x[1] * x[2], 3 * (x[2] * x[2] - x[1] * x[1]);
      return all;
    }
    double rate() const override { return 1; }
  };
  Registry registry;
  registry.flows.add<Keys>("cubic", "a flow of third degree", [](const Keys&) { return std::make_shared<Cubic>(); });
  for (const char* motion : {"free", "prescribed"}) {
    Scene cubic(registry);
    deck::read_text(std::string("Tanktread: {Flow: {type: cubic}, Particle: {motion: ") + motion + "}, Time: {final time: 1}}").declare(cubic);
    EXPECT_NO_THROW(cubic.check()) << motion;
    EXPECT_TRUE(cubic.in_system()) << motion;
  }
}

TEST(Resuming, MayChangeKeysOfTheRunButNotOfTheScene) {
  for (const char* path : {"Time/final time", "Output/interval", "Expect/volume/value", "Solvers/Belos", "Quadrature/tolerance", "Contact/limit",
                           "Interface/motion", "Particles/red/Interface/motion", "Particles/red/Adaptation/interval", "Tube/contact gap"})
    EXPECT_TRUE(may_change_on_resume(path)) << path;
  for (const char* path : {"Flow/type", "Particle/radius", "Membrane/law", "Surface/elements per side", "Output/power balance", "Contact/limiter",
                           "Particles/red/radius", "Particles/red/Membrane/law", "Particles/Contact/limit", "Tube/radius", "No section/key",
                           "Particles/red/Interface/surfactant/elasticity number", "Interface/fields/own/key"})
    EXPECT_FALSE(may_change_on_resume(path)) << path;
}

}  // namespace scene_test
}  // namespace tanktread
