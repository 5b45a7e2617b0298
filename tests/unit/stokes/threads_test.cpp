// Layers give the same bits for any number of threads.

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "base/indices.hpp"
#include "base/threads.hpp"
#include "spline/extraction.hpp"
#include "stokes/medium/lattice.hpp"
#include "stokes/medium/plane_wall.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"

namespace tanktread::stokes {
namespace layer_threads_test {

struct Case {
  const char* name;
  Layer::Kernel kernel;
  const char* far_sum;
  enum Surroundings { nothing, wall, lattice } around = nothing;
  quadrature::LayerRule rule = quadrature::LayerRule::adaptive;
};
void PrintTo(const Case& one, std::ostream* to) { *to << one.name; }

class ThreadsOfLayers : public testing::TestWithParam<Case> {
 protected:
  ~ThreadsOfLayers() override { set_threads(before_); }

  /// Returns everything that a layer computes, on n threads.
  static std::vector<double> results(const Case& of, int n) {
    set_threads(n);
    const spline::TMesh mesh = spline::cube(3);
    const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit);
    const Net x = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(0.4 * p[0] + 0.1 * p[2], 0.35 * p[1], 0.3 * p[2]); });
    const Net f = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(p[1] - 0.3, p[2] * p[0], p[0] * p[0]); });
    quadrature::Options options;
    options.rule = of.rule;
    options.far_sum = of.far_sum;
    const std::vector<int> all = indices(x.rows());
    Net off = 1.1 * x;  // close to the surface
    std::vector<double> numbers;
    const auto keep = [&](const auto& some) { numbers.insert(numbers.end(), some.data(), some.data() + some.size()); };
    for (const bool sites : {true, false}) {
      if (!sites && of.rule == quadrature::LayerRule::desingularised) continue;
      Layer layer(of.kernel, space, sites ? space.collocation : Sites{}, options);
      if (of.around == Case::wall) layer.set_medium(PlaneWall(Vec3(0, 0, -0.5), Vec3(0, 0, 1)));
      if (of.around == Case::lattice) layer.repeat(PeriodicCell(Mat3::Identity(), 3));
      layer.set_shape(x);
      Net u = Net::Zero(x.rows(), 3);
      Rows<double> rows;
      if (sites) {
        layer.apply(f, all, u);
        layer.assemble(all, rows);
        if (of.kernel == Layer::Kernel::single_layer) {
          NearPoints near;
          for (const int i : all) {
            near.point.insert(near.point.end(), {i, (i + 1) % space.n_points});
            near.first.push_back(near.point.size());
          }
          std::vector<double> entries;
          layer.assemble(all, near, entries);
          keep(entries);
        }
      } else {
        layer.apply(f, off, all, u);
        keep(u);
        const Layer::Near near = layer.near(off, all);
        layer.apply(f, off, all, u, &near);
        layer.assemble(off, all, rows);
      }
      keep(u), keep(rows);
      const Evaluations count = layer.evaluations();
      for (const long long number : {count.far, count.near, count.self}) numbers.push_back(static_cast<double>(number));
    }
    return numbers;
  }

 private:
  int before_ = n_threads();
};

TEST_P(ThreadsOfLayers, HaveTheSameBits) {
  const std::vector<double> one = results(GetParam(), 1);
  for (const int n : {2, 3, 5}) {
    const std::vector<double> several = results(GetParam(), n);
    ASSERT_EQ(several.size(), one.size());
    EXPECT_EQ(std::memcmp(several.data(), one.data(), one.size() * sizeof(double)), 0) << n;
  }
}

using enum Layer::Kernel;
INSTANTIATE_TEST_SUITE_P(All, ThreadsOfLayers,
                         testing::Values(Case{"single", single_layer, "dense"}, Case{"double", double_layer, "dense"},
                                         Case{"clusters", single_layer, "tree"}, Case{"double_clusters", double_layer, "tree"},
                                         Case{"wall", single_layer, "dense", Case::wall}, Case{"double_wall", double_layer, "tree", Case::wall},
                                         Case{"lattice", single_layer, "dense", Case::lattice},
                                         Case{"double_lattice", double_layer, "dense", Case::lattice},
                                         Case{"fixed", single_layer, "dense", Case::nothing, quadrature::LayerRule::fixed},
                                         Case{"desingularised", single_layer, "dense", Case::nothing, quadrature::LayerRule::desingularised}),
                         [](const auto& info) { return info.param.name; });

}  // namespace layer_threads_test
}  // namespace tanktread::stokes
