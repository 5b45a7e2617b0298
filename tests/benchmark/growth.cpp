// Measures how the cost of a velocity evaluation grows with the mesh: the seconds of each phase and the bytes at n = 12, 24, 48, 96, and the error of
// the far sum by clusters, compared with the direct sum at a sample of targets. tests/benchmark/growth.py runs this benchmark and draws the figure.

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "base/timing.hpp"
#include "membrane/laws.hpp"
#include "spline/extraction.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/shapes.hpp"
#include "system/capsule.hpp"
#include "tests/benchmark/clock.hpp"
#include "tests/layers.hpp"

namespace {

using namespace tanktread;

constexpr double asked = 1e-5;  // tolerance of the integrals, stricter than the default

/// Returns the bytes in use: on the heap, and mapped for large arrays.
double bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// Returns the largest resident set of the process so far, in bytes. `restart`: if true, resets this maximum first.
double peak(bool restart) {
  if (restart) {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;
  }
  std::ifstream status("/proc/self/status");
  std::string word;
  double kilobytes = 0;
  while (status >> word)
    if (word == "VmHWM:") status >> kilobytes;
  return 1024 * kilobytes;
}

/// Returns the error of the far sum by clusters in the single layer of a load, at about a thousand targets, divided by the largest velocity.
double far_error(const spline::Space& space, const Net& unstressed, const Net& x, const Net& load) {
  std::vector<int> sample;
  const int step = std::max(1, space.n_points / 1000);
  for (int i = 0; i < space.n_points; i += step) sample.push_back(i);
  Net u[2];
  for (const bool tree : {false, true}) {
    quadrature::Options options;
    options.tolerance = asked;
    options.far_sum = tree ? "tree" : "dense";
    stokes::SingleLayer layer(space, options);
    layer.set_reference(unstressed);
    u[tree] = Net::Zero(space.n_points, 3);
    layer.apply(x, load, stokes::Measure::reference, sample, u[tree]);
  }
  return (u[1] - u[0]).rowwise().norm().maxCoeff() / u[0].rowwise().norm().maxCoeff();
}

/// Measures the velocity evaluation of a capsule whose shape is roughly half-way between a sphere and its steady shape in shear.
void growth(benchmark::State& state) {
  const spline::TMesh mesh = spline::cube(static_cast<int>(state.range(0)));
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net unstressed, x;
  {
    const surface::LeastSquaresFit fit(space);
    unstressed = surface::unit_sphere(mesh, fit);
    x = fit.fit_image(unstressed, [](const Vec3& p) { return Vec3(1.3 * p[0] + 0.4 * p[2], 0.9 * p[1], 0.75 * p[2]); });
  }
  const double before = bytes();
  peak(true);
  Phases phases;
  coupling::CapsuleParameters parameters;
  parameters.particles.front().material.law = membrane::NeoHookean{1 / 0.3};
  parameters.quadrature.tolerance = asked;
  if (state.range(1) != 0) parameters.quadrature.far_sum = "dense";
  const double start = now();
  coupling::Capsule capsule(space, unstressed, unstressed, stokes::AmbientFlow(stokes::FlowOptions()), parameters, phases);
  const double setup = now() - start;
  const Net shapes[2] = {x, (1 + 1e-6) * x};              // evaluated alternately, because the velocity of the last shape is cached
  benchmark::DoNotOptimize(capsule.velocity(shapes[1]));  // computes and stores the singular quadrature rules, outside the measured time
  const long long far = capsule.kernel_evaluations().far;
  const Phases first = phases;
  const Phases layer_first = capsule.solver().layers().single_layer().phases();
  double best = 1e9;
  int turn = 0;
  for (auto _ : state) {
    const double begin = now();
    benchmark::DoNotOptimize(capsule.velocity(shapes[turn++ % 2]));
    best = std::min(best, now() - begin);
  }
  const double wall = phases.total() - first.total();
  const auto counter = [&](const std::string& name, double value) { state.counters[name] = value; };
  counter("points", space.n_points);
  counter("setup s", setup);
  counter("evaluation s", best);
  counter("far interactions", static_cast<double>(far));
  counter("bytes kept", bytes() - before);
  counter("bytes peak", peak(false));
  const auto split = [&](const Phases& all, const Phases& earlier, const char* prefix) {  // distributes `best` in proportion to the wall times
    for (const Phases::Phase& p : all.all()) counter(prefix + p.name + " s", best * (p.seconds - earlier.seconds(p.name)) / wall);
  };
  split(phases, first, "");
  split(capsule.solver().layers().single_layer().phases(), layer_first, "layer ");
  if (state.range(1) == 0) counter("far error", far_error(space, unstressed, x, capsule.evaluate(x)->load()));
}
BENCHMARK(growth)
    ->ArgNames({"n", "dense"})
    ->Args({12, 0})
    ->Args({24, 0})
    ->Args({48, 0})
    ->Args({96, 0})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(5);
BENCHMARK(growth)->ArgNames({"n", "dense"})->Args({12, 1})->Args({24, 1})->Args({48, 1})->Unit(benchmark::kMillisecond)->Iterations(2);

}  // namespace
