#include "scene/body.hpp"
#include "scene/particles/drift.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/small_matrices.hpp"
#include "spline/extraction.hpp"
#include "surface/shapes.hpp"
#include "tests/states.hpp"

namespace tanktread {
namespace {

ParticleScene scene(const std::string& flow) {
  ParticleScene s;
  s.flow.type = flow;
  if (flow == "four-roll") s.flow.roll_parameter = 0.6;
  s.particle.shape.radius = 1;
  return s;
}

TEST(Drift, AParticleIsHeldAtAStagnationPointOfADivergingFlow) {
  for (const char* flow : {"planar hyperbolic", "uniaxial extension", "four-roll"}) EXPECT_TRUE(holds_centre(scene(flow))) << flow;
  for (const char* flow : {"simple shear", "quiescent"}) EXPECT_FALSE(holds_centre(scene(flow))) << flow;
}

TEST(Drift, AParticleThatStartsElsewhereDriftsAway) {
  ParticleScene s = scene("planar hyperbolic");
  s.particle.shape.center = {0.1, 0, 0};
  EXPECT_FALSE(holds_centre(s));
}

TEST(Drift, AParticleOnWhichAForceActsIsNotHeld) {
  ParticleScene heavy = scene("planar hyperbolic");
  heavy.flow.gravity = Vec3(0, 0, -1), heavy.particle.density_difference = 1;
  EXPECT_FALSE(holds_centre(heavy));
  heavy.particle.density_difference = 0;
  EXPECT_TRUE(holds_centre(heavy));
}

TEST(Drift, AParticleInShearIsNotHeld) {
  for (const double angle : {0.3, 1.1, 2.5}) {
    ParticleScene s = scene("linear");
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    s.flow.gradient = turn.col(0) * turn.col(2).transpose();  // the exact eigenvalues are 0; rounding makes them up to 1e-5
    EXPECT_FALSE(holds_centre(s)) << angle;
  }
}

TEST(Drift, TheDeckMayOverrideTheDefault) {
  ParticleScene s = scene("planar hyperbolic");
  s.particle.drift = "free";
  EXPECT_FALSE(holds_centre(s));
  s = scene("simple shear");
  s.particle.drift = "held";
  EXPECT_TRUE(holds_centre(s));
}

TEST(Drift, MovingTheCentroidBackUpdatesTheSlopes) {
  // Points that only move with the flow, v = L x, have the slopes L x at any position.
  const stokes::AmbientFlow flow(scene("planar hyperbolic").flow);
  const spline::TMesh mesh = spline::cube(4);
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::catmull_clark);
  surface::ParticleShape shape;
  shape.shape = "ellipsoid";
  shape.semi_axes = Vec3(1.5, 1, 0.8);
  const surface::Geometry geometry(space);
  motion::TimeState state;
  state.x = state_of(surface::resting_shape(space, mesh, shape).rowwise() + Vec3(0.3, -0.2, 0.1).transpose());
  const Mat3 l = flow.gradient(Vec3::Zero());
  state.history = {state_of(net(state.x) * l.transpose())};
  hold_centre(flow, geometry, Vec3::Zero(), state);
  EXPECT_LT(geometry.measures(net(state.x)).centroid.norm(), 1e-14);
  EXPECT_LT((net(state.history[0]) - net(state.x) * l.transpose()).norm(), 1e-13);
}

// Points that only move with the flow were at exp(-L s) x a time s earlier, for any current position x.
TEST(Drift, MovingTheCentroidBackUpdatesEarlierPositions) {
  const stokes::AmbientFlow flow(scene("planar hyperbolic").flow);
  const spline::TMesh mesh = spline::cube(4);
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::catmull_clark);
  const surface::Geometry geometry(space);
  const Vec3 center(0.3, -0.2, 0.1);
  const Mat3 l = flow.gradient(center);
  motion::TimeState state;
  state.time = 2;
  state.x = state_of(surface::resting_shape(space, mesh, {}).rowwise() + center.transpose());
  const auto at = [&](double time) { return Net(net(state.x) * exponential(l * (time - state.time)).transpose()); };
  for (const double time : {1.9, 1.7, 1.6}) state.places.push_back({time, state_of(at(time))});
  const coupling::State direction = state.direction = state_of(Net::Random(space.n_points, 3));
  hold_centre(flow, geometry, Vec3::Zero(), state);
  EXPECT_LT(geometry.measures(net(state.x)).centroid.norm(), 1e-14);
  for (const motion::PastPosition& place : state.places) EXPECT_LT((net(place.x) - at(place.time)).norm(), 1e-13) << place.time;
  EXPECT_TRUE(state.direction == direction);
}

}  // namespace
}  // namespace tanktread
