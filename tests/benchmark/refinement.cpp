// Time of one refinement of a surface with about 1,500 control points, including the transfer of all fields, divided by the time of one velocity
// evaluation on the same surface.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <random>
#include <vector>

#include "base/timing.hpp"
#include "membrane/laws.hpp"
#include "spline/extraction.hpp"
#include "spline/refinement.hpp"
#include "spline/transfer.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "surface/shapes.hpp"
#include "system/capsule.hpp"
#include "tests/benchmark/clock.hpp"

namespace {

using namespace tanktread;

constexpr auto rule = spline::ExtraordinaryRule::catmull_clark;

/// Returns marks on random elements, which may occur more than once. An element is marked along both directions with probability 1/2, along s only
/// with probability 1/4, and along t only with probability 1/4.
std::vector<spline::Mark> random_marks(const spline::TMesh& mesh, int count, std::mt19937& generator) {
  const unsigned elements = static_cast<unsigned>(spline::elements(mesh).tiles.size());
  std::vector<spline::Mark> marks;
  for (int k = 0; k < count; ++k) {
    const unsigned way = generator() % 4;
    marks.push_back({static_cast<int>(generator() % elements), way != 3, way != 2});
  }
  return marks;
}

/// A cube mesh with 10 elements per side, refined at random until it has 1,500 control points.
struct Surface {
  std::mt19937 generator{7};
  spline::TMesh mesh;
  spline::Space space;
  Net unstressed, x;

  Surface() {
    const spline::TMesh first = spline::cube(10, 4);
    mesh = first;
    space = spline::space(mesh, rule);
    const surface::LeastSquaresFit fit(space);
    unstressed = surface::unit_sphere(first, fit);
    x = fit.fit_image(unstressed, [](const Vec3& p) { return Vec3(1.3 * p[0] + 0.4 * p[2], 0.9 * p[1], 0.75 * p[2]); });
    while (space.n_points < 1500) {
      mesh = spline::refine(mesh, random_marks(mesh, 10, generator)).mesh;
      spline::Space next = spline::space(mesh, rule);
      const auto transfer = spline::transfer(space, next);
      unstressed = transfer(unstressed).net;
      x = transfer(x).net;
      space = std::move(next);
    }
  }
};

/// Measures the parts of a refinement in milliseconds, each the smallest of all repetitions: refinement and repair of the mesh, the new space, and
/// the transfer of both surfaces and three more fields. The set-up of the operators on the new mesh is measured separately.
void refinement(benchmark::State& state) {
  Surface surface;
  const auto marks = random_marks(surface.mesh, static_cast<int>(state.range(0)), surface.generator);
  Phases phases;
  coupling::CapsuleParameters parameters;
  parameters.particles.front().material.law = membrane::NeoHookean{1 / 0.3};
  const stokes::AmbientFlow flow{stokes::FlowOptions()};
  coupling::Capsule capsule(surface.space, surface.unstressed, surface.unstressed, flow, parameters, phases);
  const std::vector<const Net*> fields = {&surface.unstressed, &surface.x, &surface.x, &surface.x, &surface.x};
  double mesh = 1e9, space = 1e9, transfer = 1e9, all = 1e9, evaluation = 1e9, setup = 1e9, residual = 0;
  const Net shapes[2] = {surface.x, (1 + 1e-6) * surface.x};  // evaluated alternately, because the velocity of the last shape is cached
  int points = 0, elements = 0, turn = 0;
  for (auto _ : state) {
    const double start = now();
    const spline::Refinement finer = spline::refine(surface.mesh, marks);
    const double cut = now();
    const spline::Space next = spline::space(finer.mesh, rule);
    const double made = now();
    std::vector<Net> carried;
    {
      const auto move = spline::transfer(surface.space, next);
      for (const Net* field : fields) {
        auto moved = move(*field);
        residual = std::max(residual, moved.residual);
        carried.push_back(std::move(moved.net));
      }
    }
    const double done = now();
    mesh = std::min(mesh, cut - start), space = std::min(space, made - cut), transfer = std::min(transfer, done - made);
    all = std::min(all, done - start);
    points = next.n_points;
    elements = static_cast<int>(next.elements.size());

    const double before = now();
    const coupling::Capsule finer_capsule(next, carried[0], carried[0], flow, parameters, phases);
    setup = std::min(setup, now() - before);
    const double begin = now();
    benchmark::DoNotOptimize(capsule.velocity(shapes[turn++ % 2]));
    evaluation = std::min(evaluation, now() - begin);
  }
  const auto counter = [&](const char* name, double value) { state.counters[name] = value; };
  counter("points before", surface.space.n_points);
  counter("points", points);
  counter("elements", elements);
  counter("mesh ms", 1e3 * mesh);
  counter("space ms", 1e3 * space);
  counter("transfer ms", 1e3 * transfer);
  counter("refinement ms", 1e3 * all);
  counter("residual", residual);
  counter("evaluation ms", 1e3 * evaluation);
  counter("set-up of operators ms", 1e3 * setup);
  counter("refinement / evaluation", all / evaluation);
}
BENCHMARK(refinement)->ArgName("marks")->Arg(1)->Arg(10)->Arg(50)->Unit(benchmark::kMillisecond)->Iterations(15);

}  // namespace
