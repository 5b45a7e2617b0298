// Tests of the transfer of a particle to a refined mesh and from a checkpoint.

#include "scene/particles/adaptation.hpp"

#include <gtest/gtest.h>

#include "deck/document.hpp"

namespace tanktread {
namespace {

TEST(Adaptation, AllShapesOfAParticleAreOnItsNewMesh) {
  Scene scene;
  deck::Document deck = deck::read({}, {},
                                   "Tanktread: {Flow: {type: simple shear}, Particle: {initial shape: {stretch: [1.3, 0.9, 0.8]}}, "
                                   "Membrane: {capillary number: 0.3}, Surface: {elements per side: 3}, "
                                   "Adaptation: {enabled: true, surface tolerance: 1.0e-6, levels: 1}, Time: {final time: 1}}\n");
  deck.declare(scene);
  scene.check();
  std::vector<Member> refined = make_members(scene), resumed = make_members(scene);
  const Body& body = *refined.front().body;
  Adapted change = adapted(scene.first(), body, body.initial, {}, Net::Zero(body.space.n_points, 3), false, {});
  ASSERT_TRUE(change.body);
  ASSERT_GT(change.body->space.n_points, body.space.n_points);
  EXPECT_EQ(change.body->initial, change.move(body.initial));
  refined.front().body = std::move(change.body);
  output::Checkpoint checkpoint;
  store(refined, checkpoint);
  EXPECT_TRUE(restore(checkpoint, resumed));
  for (const Net Body::*net : {&Body::rest, &Body::initial, &Body::unstressed})
    EXPECT_EQ(((*resumed.front().body).*net).rows(), resumed.front().body->space.n_points);
}

}  // namespace
}  // namespace tanktread
