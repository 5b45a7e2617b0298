// Tests of runs in flows that change in time, compared with closed forms and with the same run in a steady flow.

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/particles/particle_system.hpp"
#include "tests/evolution.hpp"

namespace tanktread {
namespace {

using std::numbers::pi;

const std::vector<std::string> capsule_in_shear = {"Surface/elements per side=3", "Surface/extraordinary points=catmull-clark",
                                                   "Membrane/law=Skalak", "Quadrature/tolerance=1e-5", "Time/final time=2"};
const std::vector<std::string> sine = {"Flow/history/type=sine", "Flow/history/frequency=0.5", "Flow/history/mean=0.5", "Flow/history/phase=30"};
const std::vector<std::string> stop = {"Flow/history/times=[0, 0.3, 0.3]", "Flow/history/amplitudes=[1, 1, 0]"};

std::vector<std::string> with(std::vector<std::string> settings, const std::vector<std::string>& more) {
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

Net shape_at(double time, const std::vector<std::string>& settings) {
  Evolution run(settings);
  run.to(time);
  return run.x();
}

TEST(FlowHistory, SchemesKeepTheirOrdersUnderASine) {
  const auto settings = with(capsule_in_shear, sine);
  const auto steps = [&](const char* scheme, const char* step) {
    return shape_at(0.4, with(settings, {std::string("Time/scheme=") + scheme, std::string("Time/fixed step=") + step, "Time/newton tolerance=1e-4",
                                         "Time/newton iterations=20", "Time/linear tolerance=1e-4", "Time/nonlinear solver=anderson"}));
  };
  const Net exact = steps("bs3", "0.005");
  const std::pair<const char*, double> orders[] = {{"tr-bdf2", 3}, {"bs3", 3}, {"rkc2", 2}, {"crank-nicolson", 2}, {"bdf3", 3}};
  for (const auto& [scheme, order] : orders) {
    const double coarse = (steps(scheme, "0.04") - exact).norm(), fine = (steps(scheme, "0.02") - exact).norm();
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.4) << scheme << ": " << coarse << " and " << fine;
  }
}

TEST(FlowHistory, ACapsuleWhoseFlowStopsRelaxes) {
  for (const char* scheme : {"tr-bdf2", "bs3", "bdf3"}) {
    Evolution run(with(capsule_in_shear, with(stop, {std::string("Time/scheme=") + scheme})));
    run.to(0.25);
    const double before = run.energy();
    while (run.state.time < 0.3) run.step(2);
    ASSERT_EQ(run.state.time, 0.3) << "a step ends where the flow stops";
    EXPECT_GT(run.energy(), before);
    while (run.state.time < 1.5) {
      const double energy = run.energy();
      run.step(1.5);
      EXPECT_LT(run.energy(), energy) << scheme << " at " << run.state.time;
    }
    EXPECT_LT(run.energy(), 0.2 * before);
  }
}

TEST(FlowHistory, AnAmplitudeOfOneIsBitwiseEqualToTheSteadyFlow) {
  for (const char* scheme : {"tr-bdf2", "auto"}) {
    const auto settings = with(capsule_in_shear, {std::string("Time/scheme=") + scheme});
    EXPECT_EQ(shape_at(0.2, settings), shape_at(0.2, with(settings, {"Flow/history/times=[0]", "Flow/history/amplitudes=[1]"})));
  }
}

TEST(FlowHistory, ARotatedFlowRotatesTheCapsule) {
  // Shear rotated by 90 degrees about x2 is the flow (x3, 0, 0) with x1 and x3 exchanged and one of them reversed. The mesh has this symmetry.
  Evolution steady(capsule_in_shear), turned(with(capsule_in_shear, {"Flow/history/times=[0]", "Flow/history/angles=[90]"}));
  steady.to(0.3);
  turned.to(0.3);
  EXPECT_NEAR(turned.deformation().taylor_inertia, steady.deformation().taylor_inertia, 1e-5);  // tolerance of the quadrature
  EXPECT_NEAR(std::remainder(turned.deformation().inclination - steady.deformation().inclination - 90, 180), 0, 1e-2);
}

TEST(FlowHistory, OnlySymmetriesOfEveryDirectionAreUsed) {
  EXPECT_EQ(Evolution(with(capsule_in_shear, {"Flow/type=planar hyperbolic"})).body().symmetry.description(), "mirror x1, mirror x2 and mirror x3");
  EXPECT_EQ(Evolution(with(capsule_in_shear, {"Flow/type=planar hyperbolic", "Flow/history/times=[0, 1]", "Flow/history/angles=[0, 30]"}))
                .body().symmetry.description(),
            "mirror x2 and point symmetry");
}

/// Returns the angle, in degrees, of the axis of a spheroid with axis ratio 1.5 that starts along x1, after the strain int a dt (Jeffery 1922).
double jeffery(double strain) { return -std::atan(std::tan(strain / (1.5 + 1 / 1.5)) / 1.5) * 180 / pi; }

TEST(FlowHistory, ASpheroidsAngleFollowsFromTheStrainSoFar) {
  const auto follow = [](const std::vector<std::string>& settings, const std::function<double(double)>& strain) {
    Scene scene;
    coupling::Ranks ranks;
    Phases phases;
    deck::Document deck = deck::read({SOURCE_DIRECTORY "/inputs/jeffery.yaml"}, settings);
    deck.declare(scene);
    scene.check();
    const std::unique_ptr<ParticleSystem> body = make_particle_system(scene, ranks, phases);
    const auto scheme = motion::integrator(scene.time);
    motion::TimeState state;
    state.x = body->start();
    motion::begin(body->dynamics(), state);
    state.step = motion::first_step(body->dynamics(), state, scene.time);
    while (state.time < 3) {
      scheme->advance(body->dynamics(), state, 3);
      const double found = body->next_row(state, {}).value("inclination");
      EXPECT_NEAR(found, jeffery(strain(state.time)), 2e-3) << "at " << state.time;  // six elements per side cause an error of 1e-5 of a period
    }
  };
  follow({"Flow/history/type=sine", "Flow/history/frequency=0.25", "Flow/history/amplitude=2"},
         [](double t) { return 4 / pi * (1 - std::cos(pi / 2 * t)); });
  follow({"Flow/history/times=[0, 1, 2, 2]", "Flow/history/amplitudes=[0, 2, 2, 0]"},
         [](double t) { return t < 1 ? t * t : std::min(2 * t - 1, 3.0); });
}

}  // namespace
}  // namespace tanktread
