// Measures the kernel evaluations per second of the bare far-field sum, and the parts of the single layer and of a whole velocity evaluation at
// n = 6, 12, 24, each relative to the bare sum of the same run.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "base/timing.hpp"
#include "membrane/laws.hpp"
#include "spline/extraction.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "surface/shapes.hpp"
#include "system/capsule.hpp"
#include "tests/benchmark/clock.hpp"
#include "tests/layers.hpp"

namespace {

using namespace tanktread;

/// Interactions per second of the minimal far sum, the largest rate of all runs so far. All other benchmarks are compared with this rate.
double bare_rate = 0;

void bare_far_sum(benchmark::State& state) {
  const int n = 864 * 16, blocks = 54;
  std::vector<double> forces(static_cast<std::size_t>(6) * n), targets(3 * stokes::far_block * blocks), u(3 * stokes::far_block);
  for (std::size_t k = 0; k < forces.size(); ++k) forces[k] = std::sin(1. + static_cast<double>(k));
  for (std::size_t k = 0; k < targets.size(); ++k) targets[k] = std::cos(1. + static_cast<double>(k));
  const double* f = forces.data();
  const double pairs = static_cast<double>(n) * stokes::far_block * blocks;
  for (auto _ : state) {
    const double start = now();
    for (int b = 0; b < blocks; ++b) {
      stokes::stokeslet_sum(stokes::Charges{n, f, f + n, f + 2 * n, {f + 3 * n, f + 4 * n, f + 5 * n}}, &targets[3 * stokes::far_block * b],
                      u.data());
      benchmark::DoNotOptimize(u.data());
    }
    bare_rate = std::max(bare_rate, pairs / (now() - start));
  }
  state.counters["interactions/s"] = bare_rate;
}
BENCHMARK(bare_far_sum)->Unit(benchmark::kMillisecond)->Iterations(30);

struct Scene {
  spline::Space space;
  Net unstressed, x, f;
  std::vector<int> all;

  explicit Scene(int n, spline::ExtraordinaryRule rule = spline::ExtraordinaryRule::g1) {
    const spline::TMesh mesh = spline::cube(n);
    space = spline::space(mesh, rule);
    const surface::LeastSquaresFit fit(space);
    unstressed = surface::unit_sphere(mesh, fit);
    x = fit.fit_image(unstressed, [](const Vec3& p) { return Vec3(1.3 * p[0] + 0.4 * p[2], 0.9 * p[1], 0.75 * p[2]); });
    f = fit.fit_image(unstressed, [](const Vec3& p) { return Vec3(p[2], 0.1 * p[1], p[0]); });
    all.resize(space.n_points);
    std::iota(all.begin(), all.end(), 0);
  }
};

/// Returns two shapes that are evaluated alternately, because the velocity of the shape evaluated last is cached.
std::array<Net, 2> in_turns(const Net& x) { return {x, Net((1 + 1e-6) * x)}; }

/// Measures Layer::apply: the time of each part, the rate of its far sum divided by the rate of the minimal far sum, and the total time divided by
/// the time of the far sum.
void single_layer(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  stokes::SingleLayer layer(scene.space, {});
  layer.set_reference(scene.unstressed);
  Net u = Net::Zero(scene.space.n_points, 3);
  layer.apply(scene.x, scene.f, stokes::Measure::reference, scene.all, u);
  std::vector<double> best(4, 1e9);
  const char* const parts[] = {"setup", "far", "near", "self"};
  for (auto _ : state) {
    double before[4];
    for (int k = 0; k < 4; ++k) before[k] = layer.phases().seconds(parts[k]);
    layer.apply(scene.x, scene.f, stokes::Measure::reference, scene.all, u);
    for (int k = 0; k < 4; ++k) best[k] = std::min(best[k], layer.phases().seconds(parts[k]) - before[k]);
  }
  for (int k = 0; k < 4; ++k) state.counters[std::string(parts[k]) + " ms"] = 1e3 * best[k];
  const double pairs = static_cast<double>(scene.space.n_points) * layer.n_nodes();
  state.counters["far rate / bare"] = pairs / best[1] / bare_rate;
  state.counters["all / far"] = std::accumulate(best.begin(), best.end(), 0.) / best[1];
}
BENCHMARK(single_layer)->Arg(6)->Arg(12)->Arg(24)->Unit(benchmark::kMillisecond)->Iterations(30);

/// Measures the assembly of the frozen rows for the Jacobian. Unit: the time of one minimal far sum.
void assembled_rows(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  stokes::SingleLayer layer(scene.space, {});
  layer.set_reference(scene.unstressed);
  stokes::Rows<float> rows;
  double best = 1e9;
  for (auto _ : state) {
    const double start = now();
    layer.assemble(scene.x, stokes::Measure::reference, scene.all, rows);
    best = std::min(best, now() - start);
  }
  state.counters["bare far sums"] = best * bare_rate / (static_cast<double>(scene.space.n_points) * layer.n_nodes());
}
BENCHMARK(assembled_rows)->Arg(6)->Arg(12)->Unit(benchmark::kMillisecond)->Iterations(10);

/// Measures one velocity evaluation of a capsule (4.2) in processor time, the smallest of all repetitions: the total time divided by the time of the
/// minimal far sum, the mean fraction of each phase, and the time of the membrane tangent divided by the time of the evaluation.
void velocity_evaluation(benchmark::State& state) {
  const Scene scene(static_cast<int>(state.range(0)));
  Phases phases;
  coupling::CapsuleParameters parameters;
  parameters.particles.front().material.law = membrane::NeoHookean{1 / 0.3};
  stokes::FlowOptions shear;
  coupling::Capsule capsule(scene.space, scene.unstressed, scene.unstressed, stokes::AmbientFlow(shear), parameters, phases);
  const auto x = in_turns(scene.x);
  int turn = 0;
  benchmark::DoNotOptimize(capsule.velocity(x[1]));
  const long long far = capsule.kernel_evaluations().far;
  const Phases before = phases;
  double best = 1e9, tangent = 1e9;
  for (auto _ : state) {
    const double start = now();
    benchmark::DoNotOptimize(capsule.velocity(x[turn++ % 2]));
    best = std::min(best, now() - start);
  }
  for (const Phases::Phase& phase : phases.all())
    state.counters[phase.name] = (phase.seconds - before.seconds(phase.name)) / (phases.total() - before.total());
  for (int k = 0; k < 10; ++k) {
    const double start = now();
    capsule.linearise(scene.x);
    tangent = std::min(tangent, now() - start);
  }
  state.counters["all / far"] = best * bare_rate / static_cast<double>(far);
  state.counters["tangent / all"] = tangent / best;
}
BENCHMARK(velocity_evaluation)->Arg(6)->Arg(12)->Arg(24)->Unit(benchmark::kMillisecond)->Iterations(30);

/// Measures the time of a velocity evaluation with the Catmull-Clark rule divided by its time with the G1 rule. Catmull-Clark has more elements at
/// the extraordinary points. The two are evaluated alternately; the smallest time of each counts.
void catmull_clark_over_g1(benchmark::State& state) {
  Phases phases[2];
  coupling::CapsuleParameters parameters;
  parameters.particles.front().material.law = membrane::NeoHookean{1 / 0.3};
  const stokes::AmbientFlow flow{stokes::FlowOptions()};
  const int n = static_cast<int>(state.range(0));
  const Scene scene[2] = {Scene(n), Scene(n, spline::ExtraordinaryRule::catmull_clark)};
  coupling::Capsule capsule[2] = {
      {scene[0].space, scene[0].unstressed, scene[0].unstressed, flow, parameters, phases[0]},
      {scene[1].space, scene[1].unstressed, scene[1].unstressed, flow, parameters, phases[1]},
  };
  const std::array<Net, 2> x[2] = {in_turns(scene[0].x), in_turns(scene[1].x)};
  for (int k : {0, 1}) benchmark::DoNotOptimize(capsule[k].velocity(x[k][1]));
  const stokes::Evaluations first[2] = {capsule[0].kernel_evaluations(), capsule[1].kernel_evaluations()};
  double best[2] = {1e9, 1e9};
  int turn = 0;
  for (auto _ : state) {
    for (int k : {0, 1}) {
      const double start = now();
      benchmark::DoNotOptimize(capsule[k].velocity(x[k][turn % 2]));
      best[k] = std::min(best[k], now() - start);
    }
    ++turn;
  }
  for (const char* part : {"setup", "far", "near", "self"}) {
    const auto seconds = [&](int k) { return capsule[k].solver().layers().single_layer().phases().seconds(part); };
    state.counters[std::string(part) + " ratio"] = seconds(1) / seconds(0);
  }
  for (const Phases::Phase& phase : phases[0].all()) state.counters[phase.name + " ratio"] = phases[1].seconds(phase.name) / phase.seconds;
  const auto evaluations = [&](int k) { return static_cast<double>(capsule[k].kernel_evaluations().far - first[k].far); };
  state.counters["far evaluations ratio"] = evaluations(1) / evaluations(0);
  state.counters["g1 ms"] = 1e3 * best[0];
  state.counters["all ratio"] = best[1] / best[0];
}
BENCHMARK(catmull_clark_over_g1)->Arg(6)->Arg(12)->Unit(benchmark::kMillisecond)->Iterations(60);

}  // namespace
