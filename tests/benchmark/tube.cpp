// Time of one velocity evaluation of a capsule in a tube (602 + 21 x 20 control points) divided by the time for the same capsule without the tube.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>

#include "base/timing.hpp"
#include "membrane/laws.hpp"
#include "spline/extraction.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/shapes.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/capsule.hpp"
#include "system/solids/ducts/duct.hpp"
#include "tests/benchmark/clock.hpp"

namespace {

using namespace tanktread;

/// A capsule of a = 0.6 R_T, somewhat deformed, 0.2 R_T below the axis.
struct Capsule {
  spline::Space space;
  Net unstressed, x;
  coupling::CapsuleParameters parameters;

  explicit Capsule(double viscosity_ratio) {
    const spline::TMesh mesh = spline::cube(10);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit);
    const Vec3 centre(0, 0, -0.2);
    unstressed = (0.6 / 1.02 * sphere).rowwise() + centre.transpose();
    x = fit.fit_image(sphere, [&](const Vec3& p) { return Vec3(centre + 0.6 * Vec3(p[0] + 0.2 * p[2] * p[2] - 0.1, 1.02 * p[1], 0.98 * p[2])); });
    parameters.particles.front().material.law = membrane::Skalak{10, 1};
    parameters.particles.front().viscosity_ratio = viscosity_ratio;
    parameters.particles.front().radius = 0.6;
  }

  double seconds(const stokes::AmbientFlow& flow, Phases& phases, std::unique_ptr<coupling::Tube> tube,
                 long& iterations) const {
    coupling::Capsule capsule(space, unstressed, x, flow, parameters, phases, std::move(tube));
    const Net shapes[2] = {x, (1 + 1e-6) * x};  // evaluated alternately, because the velocity of the last shape is cached
    double best = 1e9;
    for (int k = 0; k < 12; ++k) {
      const double start = now();
      benchmark::DoNotOptimize(capsule.velocity(shapes[k % 2]));
      best = std::min(best, now() - start);
    }
    iterations = capsule.counts().most_velocity_iterations;
    return best;
  }
};

/// Returns the smallest time of twelve calls of action().
template <class Action>
double milliseconds(const Action& action) {
  double best = 1e9;
  for (int k = 0; k < 12; ++k) {
    const double start = now();
    action();
    best = std::min(best, now() - start);
  }
  return 1e3 * best;
}

void velocity_evaluation_in_a_tube(benchmark::State& state) {
  const Capsule capsule(static_cast<double>(state.range(0)));
  Phases phases;
  surface::TubeOptions options;
  options.radius = 1;
  options.azimuthal_elements = 21;
  options.axial_elements = 17;
  const auto duct = std::make_shared<const stokes::DuctFlow>(options, 1.0, 1.0);
  const surface::TubeWall wall = surface::tube_wall(duct->outline(), options, 2 * 3.14159265358979);
  coupling::TubeParameters parameters;
  stokes::FlowOptions shear, in_duct;
  in_duct.type = "duct";
  in_duct.mean_velocity = 1;
  for (auto _ : state) {
    long without = 0, with = 0;
    const double free = capsule.seconds(stokes::AmbientFlow(shear), phases, nullptr, without);
    const double confined = capsule.seconds(stokes::AmbientFlow(in_duct, duct), phases,
                                            std::make_unique<coupling::Tube>(wall, *duct, capsule.space, parameters, phases), with);
    state.counters["tube ms"] = 1e3 * confined;
    coupling::Tube tube(wall, *duct, capsule.space, parameters, phases);
    const double ratio = capsule.parameters.particles.front().viscosity_ratio;
    const coupling::Particle particle{.space = &capsule.space, .block = spline::whole(capsule.space), .viscosity_ratio = ratio};
    tube.set_particles(capsule.unstressed, {&particle, 1});
    tube.set_shape(capsule.x);
    const Net f = capsule.x;
    coupling::Tube::Response response = tube.respond(f);
    state.counters["shape ms"] = milliseconds([&] { tube.set_shape(capsule.x); });
    state.counters["load on wall ms"] = milliseconds([&] { tube.cause(f, {}); });
    state.counters["velocity on wall ms"] = milliseconds([&] { tube.cause({}, f); });
    state.counters["wall solve ms"] = milliseconds([&] { tube.duct().traction(response.on_wall, 0); });
    state.counters["wall on particle ms"] = milliseconds([&] { tube.add_answer(response); });
    state.counters["tube / free"] = confined / free;
    state.counters["iterations"] = static_cast<double>(with);
    state.counters["iterations, free"] = static_cast<double>(without);
  }
}
BENCHMARK(velocity_evaluation_in_a_tube)->ArgName("viscosity ratio")->Arg(1)->Arg(5)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
