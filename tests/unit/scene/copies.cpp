// Tests of the number and the positions of copies of a particle.

#include "scene/copies.hpp"

#include <string>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "deck/document.hpp"
#include "scene/packing.hpp"
#include "scene/scene.hpp"
#include "refusal.hpp"

namespace tanktread {
namespace copies_test {

struct Expanded {
  std::vector<ParticleKind> particles;
  std::optional<stokes::PeriodicCell> cell;
};

/// Returns the copies of a particle with these keys, in a scene with these other sections.
Expanded expanded(const std::string& keys, const std::string& sections = "") {
  Scene scene;
  deck::Document document = deck::read({}, {"Time/final time=1"}, "Tanktread:\n" + sections + "  Particles:\n    many: {" + keys + "}\n");
  document.declare(scene);
  return {with_copies(scene.particles, scene.domain), scene.domain.cell()};
}

std::string refusal(const std::string& keys) {
  return refusal_of([&] { expanded(keys); });
}

TEST(Copies, HaveTheirVolumeFractionWithTheVolumeThatTheyKeep) {
  const auto number = [](const std::string& initial) {
    return expanded("radius: 0.5" + initial + ", copies: {volume fraction: 0.05, box: [8, 8, 8]}").particles.size();
  };
  // 0.05 8^3/(pi/6) = 48.9, and divided by the determinant 1.8 of the map of the initial shape 27.2
  EXPECT_EQ(number(""), 49u);
  EXPECT_EQ(number(", initial shape: {stretch: [1, 1, 1.8]}"), 49u);
  EXPECT_EQ(number(", initial shape: {stretch: [1, 1, 1.8], volume: own}"), 27u);
  EXPECT_EQ(number(", orientation: [20, 0, 70], initial shape: {map: [1, 0.3, 0, 0, 1, 0, 0, 0, 1.8], volume: own}"), 27u);
  EXPECT_EQ(number(", initial shape: {file: none.iga}"), 49u);
}

TEST(Copies, OfAShapeWhoseVolumeIsNotKnownNeedANumber) {
  for (const std::string shape : {"file: none.iga", "run: none"}) {
    const std::string initial = "initial shape: {" + shape + ", volume: own}, copies: {box: [8, 8, 8], ";
    const std::string message = refusal(initial + "volume fraction: 0.05}");
    EXPECT_NE(message.find("Particles/many/copies/volume fraction"), std::string::npos) << message;
    EXPECT_NE(message.find("give `number`"), std::string::npos) << message;
    EXPECT_EQ(refusal(initial + "number: 4}"), "");
  }
  EXPECT_NE(refusal("initial shape: {map: [1, 0, 0, 0, 1, 0, 0, 0, 0], volume: own}, copies: {volume fraction: 0.05, box: [8, 8, 8]}")
                .find("positive determinant"),
            std::string::npos);
}

/// The centres fill a box that is as wide as a period, so that copies cross the faces of the cell.
TEST(Copies, AtRandomPositionsInABoxDoNotOverlapPeriodicImages) {
  for (const std::string domain : {"periodic: x1 x2, side lengths: [4, 4, 1]", "periodic: x1, side lengths: [4, 1, 1]", "side lengths: [4, 4, 4]",
                                   "periodic: x1 x2, lattice vectors: [4, 0, 0, 1.9, 4, 0, 0, 0, 1]"}) {
    const auto [particles, cell] = expanded("radius: 0.5, copies: {number: 20, box: [5, 5, 5]}", "  Domain: {" + domain + "}\n");
    ASSERT_EQ(particles.size(), 20u);
    ASSERT_TRUE(cell);
    bool crosses = false;
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 apart = particles[i].particle.shape.center - particles[j].particle.shape.center;
        for (const Vec3& image : cell->around({2, 2, 2})) {
          EXPECT_GE((apart + image).norm(), 1.025) << domain;  // the diameter and a gap of 0.05 radii
          crosses = crosses || (!image.isZero(0) && (apart + image).norm() < 1.5);
        }
      }
    EXPECT_TRUE(crosses) << domain << ": no two copies are close across a face";
  }
}

TEST(Copies, HaveOneRegion) {
  CopiesOptions copies;
  EXPECT_EQ(copies.region(), CopiesOptions::Region::cell);
  EXPECT_FALSE(copies.in_cell()) << "not at random positions";
  copies.number = 3;
  EXPECT_TRUE(copies.in_cell());
  copies.ball = 2;
  EXPECT_EQ(copies.region(), CopiesOptions::Region::ball);
  EXPECT_FALSE(copies.in_cell());
}

}  // namespace copies_test
}  // namespace tanktread
