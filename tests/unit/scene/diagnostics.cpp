#include "scene/series/diagnostics.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "scene/body.hpp"
#include "scene/domain.hpp"
#include "scene/series/run_totals.hpp"
#include "scene/series/series.hpp"
#include "spline/extraction.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

namespace tanktread {
namespace {

TEST(Series, AreDeclaredOnce) {
  Scene deforming, free, prescribed, several;
  for (Scene* one : {&deforming, &free, &prescribed}) one->particles.resize(1);
  free.particles[0].particle.motion = Motion::free, prescribed.particles[0].particle.motion = Motion::prescribed;
  several.particles.resize(2);
  several.particles[0].name = "a", several.particles[1].name = "b", several.particles[1].particle.motion = Motion::free;
  for (const Scene& scene : {deforming, free, prescribed, several}) {
    std::set<std::string> names;
    for (const Column& one : columns(scene).all()) EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_TRUE(names.contains(scene.named() ? "b/volume" : "volume") || scene.particles[0].particle.motion == Motion::free);
  }
}

TEST(Series, OfTheProgramAreInTheOrderOfTheManual) {
  Columns row;
  for (const char* name : {"of a part", "kernel_evaluations", "cell_2_x1", "axis_1_x1", "axis_3", "time"}) row.add(0, {name, "1", ""});
  put_in_order(row);
  std::vector<std::string> names;
  for (const Column& one : row.all()) names.push_back(one.name);
  EXPECT_EQ(names, (std::vector<std::string>{"time", "axis_3", "axis_1_x1", "cell_2_x1", "kernel_evaluations", "of a part"}));
}

/// Returns a row in which all values are set.
DeformingRow complete_row() {
  DeformingRow now;
  now.measures = {1, 1, Vec3::Zero(), Mat3::Identity()};
  now.shape = {0, 0, 0, Vec3::Ones()};
  now.treading = {0, 0};
  now.stresslet = Mat3::Zero();
  now.centre = now.velocity = Vec3::Zero();
  now.intrinsic_viscosity = now.phase = now.volume_error = now.refit_error = now.normal_velocity = now.shape_velocity = 0;
  now.tension = {0, 0, 0};
  return now;
}

TEST(Series, ThatARowDoesNotSetEndTheRun) {
  const std::function<void(DeformingRow&)> all[] = {
      [](DeformingRow& row) { row.stresslet = DeformingRow().stresslet; }, [](DeformingRow& row) { row.axes = DeformingRow().axes; },
      [](DeformingRow& row) { row.phase = DeformingRow().phase; },         [](DeformingRow& row) { row.shape = DeformingRow().shape; },
      [](DeformingRow& row) { row.measures = DeformingRow().measures; },   [](DeformingRow& row) { row.tension = DeformingRow().tension; }};
  for (const auto& forget : all) {
    DeformingRow now = complete_row();
    now.axes.lengths = Vec3::Ones();
    Columns complete, incomplete;
    now.add_columns(ParticleScene(), complete);
    EXPECT_NO_THROW(finish(complete));
    forget(now);
    now.add_columns(ParticleScene(), incomplete);
    EXPECT_THROW(finish(incomplete), RunFailure);
  }
}

TEST(Series, ThatMayBeUndefinedDoNotEndTheRun) {
  DeformingRow now = complete_row();
  now.shape.inclination = std::numeric_limits<double>::quiet_NaN();
  now.axes.lengths = Vec3(2, 1, 1);
  now.axes.directions = Mat3::Identity();
  Columns row;
  now.add_columns(ParticleScene(), row);
  EXPECT_NO_THROW(finish(row));
  std::set<std::string> undefined;
  for (const Column& one : row.all())
    if (std::isnan(row.value(one.name))) undefined.insert(one.name);
  EXPECT_EQ(undefined, (std::set<std::string>{"inclination", "axis_1_x1", "axis_1_x2", "axis_1_x3"}));
  now.axes.longest_defined = true;
  Columns defined;
  now.add_columns(ParticleScene(), defined);
  EXPECT_EQ(defined.value("axis_1_x1"), 1);
  now.volume_error = std::numeric_limits<double>::quiet_NaN();
  Columns failed;
  now.add_columns(ParticleScene(), failed);
  EXPECT_THROW(finish(failed), RunFailure);
}

/// Returns the inclination of an ellipsoid in a flow.
double inclination(const Vec3& semi_axes, const stokes::FlowOptions& flow) {
  const spline::TMesh mesh = spline::cube(4);
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  surface::ParticleShape shape;
  shape.shape = "ellipsoid";
  shape.semi_axes = semi_axes;
  const surface::Geometry geometry(space);
  const Net x = surface::resting_shape(space, mesh, shape);
  return deformation(geometry, flow_plane(flow), x, geometry.measures(x), coupling::Ranks()).inclination;
}

stokes::FlowOptions linear(std::initializer_list<double> rows) {
  stokes::FlowOptions flow;
  flow.type = "linear";
  flow.gradient = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.begin());
  return flow;
}

TEST(FlowPlanes, AreX1X3ForBuiltInFlows) {
  for (const char* type : {"simple shear", "uniaxial extension", "quiescent"}) {
    stokes::FlowOptions flow;
    flow.type = type;
    EXPECT_TRUE(flow_plane(flow).fixed()) << type;
  }
  EXPECT_TRUE(flow_plane(linear({0, 0, 1, 0, 0, 0, 0, 0, 0})).fixed());
}

TEST(FlowPlanes, AreThoseInWhichALinearFlowMovesAndChanges) {
  EXPECT_EQ(flow_plane(linear({0, 1, 0, 0, 0, 0, 0, 0, 0})).description(), "in the plane x1 x2");
  EXPECT_EQ(flow_plane(linear({0, 0, 0, 0, 0, 1, 0, 0, 0})).description(), "in the plane x2 x3");
  EXPECT_EQ(flow_plane(linear({1, 0.3, 0, 0.2, -1, 0, 0, 0, 0})).description(), "in the plane x1 x2");
  // Rotating a shear flow rotates its plane, and the vorticity stays along the normal.
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  stokes::FlowOptions flow = linear({0, 0, 1, 0, 0, 0, 0, 0, 0});
  flow.gradient = turn * *flow.gradient * turn.transpose();
  const FlowPlane plane = flow_plane(flow);
  EXPECT_TRUE(plane.contains_flow);
  EXPECT_NEAR(std::abs(plane.components(turn.col(1))[1]), 1, 1e-12);
  EXPECT_LT((plane.axes * plane.axes.transpose() - Mat3::Identity()).norm(), 1e-14);
}

// The first normal stress difference is the normal stress along the flow minus the normal stress along its gradient, for any directions of the two.
TEST(FlowPlanes, HaveTheDirectionsOfAShearFlow) {
  const Mat3 stress = (Mat3() << 3, 0.2, 0.5, 0.2, -1, 0.1, 0.5, 0.1, -2).finished();  // shear along x1 with the gradient along x3
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mat3 swap = (Mat3() << 0, 0, 1, 0, 1, 0, 1, 0, 0).finished();  // shear along x3 with the gradient along x1
  for (const Mat3& q : {Mat3(Mat3::Identity()), turn, swap}) {
    stokes::FlowOptions flow = linear({0, 0, 1, 0, 0, 0, 0, 0, 0});
    flow.gradient = q * *flow.gradient * q.transpose();
    const FlowPlane plane = flow_plane(flow);
    DomainRow row;
    row.set_stress(1, *flow.gradient, stokes::PeriodicCell(Mat3::Identity(), 3), plane.of_shear.value_or(plane.axes), 0,
                   q * stress * q.transpose(), Vec3::Zero());
    EXPECT_NEAR(row.normal_stress_differences[0], 5, 1e-12);
    EXPECT_NEAR(row.normal_stress_differences[1], -1, 1e-12);
  }
  EXPECT_FALSE(flow_plane(linear({1, 0.3, 0, 0.2, -1, 0, 0, 0, 0})).of_shear);
}

TEST(FlowPlanes, DoNotExistForANonplanarFlow) {
  const FlowPlane plane = flow_plane(linear({1, 0.5, 0, -0.5, 1, 0, 0, 0, -2}));
  EXPECT_FALSE(plane.contains_flow);
  EXPECT_EQ(plane.axes.row(1).cwiseAbs(), Eigen::RowVector3d(0, 0, 1));  // the normal is along the vorticity
}

TEST(Inclination, IsUndefinedIfThePlaneOfANonplanarFlowIs) {
  const stokes::FlowOptions planar = linear({0, 0, 1, 0, 0, 0, 0, 0, 0}), other = linear({1, 0.5, 0, -0.5, 1, 0, 0, 0, -2});
  EXPECT_NEAR(inclination(Vec3(3, 2, 1), planar), 0, 1e-9);
  EXPECT_NEAR(inclination(Vec3(3, 2, 1), other), 0, 1e-9);
  EXPECT_NEAR(inclination(Vec3(2, 1, 1), planar), 0, 1e-9);
  EXPECT_TRUE(std::isnan(inclination(Vec3(2, 1, 1), other)));
  EXPECT_TRUE(std::isnan(inclination(Vec3(2, 2, 1), other)));
  EXPECT_TRUE(std::isnan(inclination(Vec3(1, 2, 1), planar)));
}

// At a pole only one tangent is not zero.
TEST(SiteAhead, IsFoundAtAPoleToo) {
  for (const spline::PoleRule rule : {spline::PoleRule::plain, spline::PoleRule::c1}) {
    const spline::PolarMesh mesh{10, 4, rule};
    const spline::Space space = spline::space(mesh);
    surface::ParticleShape shape;
    shape.radius = 1;
    const Net sphere = surface::resting_shape(space, mesh, 0, shape);
    for (const double away : {0.0, 1e-3, 0.02, 0.1}) {
      const FlowPlane plane = plane_normal_to(Vec3(std::sin(away), 1, 0.7 * away));
      const spline::Site site = site_ahead(space, sphere, Vec3::Zero(), plane);
      const Vec3 y = plane.components(surface::value(space, sphere, site));
      EXPECT_NEAR(y[0] / y.norm(), 1, 1e-9) << away;  // the error of the angle is then below 1e-4
    }
  }
}

TEST(Turnings, CountWholeTurns) {
  PhaseAngle turning;
  double angle = 0;
  for (int k = 1; k <= 40; ++k) {
    angle += 100;  // each step is more than a quarter turn
    turning.advance(1, 100 * std::numbers::pi / 180, std::remainder(angle, 360));
    EXPECT_NEAR(turning.degrees, angle, 1e-9);
  }
  turning.advance(0.5, 100 * std::numbers::pi / 180, {});
  EXPECT_NEAR(turning.degrees, angle + 50, 1e-9);
}

}  // namespace
}  // namespace tanktread
