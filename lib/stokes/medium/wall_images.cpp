#include "stokes/medium/wall_images.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "stokes/kernels/image_kernel.hpp"

namespace tanktread::stokes {
namespace {

/// Factor that reduces the tolerance of clusters for the images in the wall, because the image kernel is singular by two orders more than the
/// free-space kernel. The factor was chosen from errors measured on spheres and ellipsoids near a wall.
constexpr double share_of_clusters = 0.25;

/// Transforms the Bezier points of a panel (if `point` is true), or the Bezier coefficients of a vector field on the panel (if false), to the wall's
/// axes.
std::vector<double> turned(const PlaneWall& wall, const double* bezier, int n_b, bool point) {
  std::vector<double> own(static_cast<std::size_t>(3 * n_b));
  for (int b = 0; b < n_b; ++b) {
    const Vec3 value(bezier[b], bezier[n_b + b], bezier[2 * n_b + b]), there = point ? wall.in_axes(value) : Vec3(wall.axes() * value);
    for (int c = 0; c < 3; ++c) own[static_cast<std::size_t>(n_b * c + b)] = there[c];
  }
  return own;
}

ImageSum::Kind image_kind(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return ImageSum::Kind::forces;
    case LayerKernel::double_layer: return ImageSum::Kind::stresslets;
  }
  throw std::logic_error("unknown LayerKernel");
}

}  // namespace

WallImages::WallImages(const PlaneWall& wall, const LayerSources& sources, bool by_clusters)
    : sum_(image_kind(sources.kernel()), wall, by_clusters ? std::optional(share_of_clusters * sources.surface.options.tolerance) : std::nullopt) {}

void WallImages::add(LayerSources& sources, const LayerTargets& targets, Net& u) {
  add_far(sources, targets, u);
  const auto clock = sources.phases.time("near images");
  each_item(targets.rows.size(), [&](std::size_t k) {
    const int i = targets.rows[k];
    const Vec3 at = targets.at.row(i).transpose(), mirrored = sum_.wall().mirrored(at);
    for (const int e : sources.surface.near(mirrored, {})) {
      const PointTable& table = sources.surface.near_field.rule(e, mirrored, {});
      u.row(i) += beyond_far_sum(sources, e, table, mirrored, at, targets.f0.row(i)).transpose();
    }
  });
}

/// Adds the far sum over the images. For a double layer this is sum_k T^I (f - m) n - (sum_k T^I n)(f0 - m) over the nodes k, with the image
/// stresslet T^I (2.36), the mean m of the density f, and the constant f0 that is subtracted from f at the target.
void WallImages::add_far(LayerSources& sources, const LayerTargets& targets, Net& u) {
  const auto clock = sources.phases.time("images in the wall");
  std::vector<Vec3> at;
  std::vector<int> wanted;
  for (const int i : targets.in_tree) at.emplace_back(targets.at.row(i).transpose());
  for (const int i : targets.far_rows)
    wanted.push_back(static_cast<int>(std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin()));
  const bool others = sum_.want(std::move(at), std::move(wanted));
  Net sums;
  switch (sources.kernel()) {
    case LayerKernel::single_layer: sums = sum_.sum(sources.density); break;
    case LayerKernel::double_layer: {
      const Vec3 mean = sources.mean_density();
      if (others) compute_image_stress(sources);
      sums = sum_.sum(sources.stresslet_moments(mean));
      for (std::size_t k = 0; k < targets.far_rows.size(); ++k)
        sums.row(static_cast<Eigen::Index>(k)) -= (image_stress_[k] * (targets.f0.row(targets.far_rows[k]).transpose() - mean)).transpose();
      break;
    }
  }
  sources.counts.mine().far += sum_.interactions();
  for (std::size_t k = 0; k < targets.far_rows.size(); ++k) u.row(targets.far_rows[k]) += sums.row(static_cast<Eigen::Index>(k));
}

void WallImages::compute_image_stress(LayerSources& sources) {
  for (int c = 0; c < 3; ++c) {
    const Net sums = sum_.sum(sources.stresslet_moments_of_constant(c));
    image_stress_.resize(static_cast<std::size_t>(sums.rows()));
    for (std::size_t k = 0; k < image_stress_.size(); ++k) image_stress_[k].col(c) = sums.row(static_cast<Eigen::Index>(k)).transpose();
    sources.counts.mine().far += sum_.interactions();
  }
}

/// Returns the contribution of the image of panel e by the near-singular rule `table`, minus the contribution of this image to the far sum.
Vec3 WallImages::beyond_far_sum(LayerSources& sources, int e, const PointTable& table, const Vec3& mirrored, const Vec3& at,
                                const Vec3& f0) const {
  const PlaneWall& wall = sum_.wall();
  const Panel& panel = sources.surface.panels[e];
  const int n_b = panel.table->n_bernstein, n = panel.table->n_nodes, first = panel.first_node;
  const std::vector<double> x = turned(wall, &sources.surface.bezier[panel.first_bezier], n_b, true);
  const std::vector<double> f = turned(wall, &sources.bezier_f[panel.first_bezier], n_b, false);
  const Vec3 below = wall.in_axes(mirrored), value = wall.axes() * f0;
  sources.counts.mine().near += table.points + n;
  Vec3 better;
  Charges nodes{n, nullptr, nullptr, nullptr, {}};
  std::vector<double> strengths[6];
  const auto &density = sources.density, &normal = sources.normal;
  switch (sources.kernel()) {
    case LayerKernel::single_layer:
      image_single_sum(table, x.data(), f.data(), sources.area_weights_of(e, table, nullptr), below.data(), better.data());
      for (std::size_t c = 0; c < 3; ++c) nodes.q[c] = &density[c][first];
      break;
    case LayerKernel::double_layer:
      image_double_sum(table, x.data(), f.data(), below.data(), value.data(), better.data());
      for (std::size_t s = 0; s < 6; ++s) {
        const auto [i, j] = stresses[s];
        for (int k = first; k < first + n; ++k)
          strengths[s].push_back(((density[i][k] - f0[i]) * normal[j][k] + (density[j][k] - f0[j]) * normal[i][k]) / 2);
        nodes.q[s] = strengths[s].data();
      }
      break;
  }
  return sources.factor(e) * (wall.axes().transpose() * better) - sum_.sum(nodes, first, at);
}

/// Computes the moments of the image of panel e at the target `at`: one matrix per Bernstein polynomial, in the laboratory axes, including the factor
/// k_p (2.1) of the panel.
void WallImages::panel_moments(LayerSources& sources, int e, const Vec3& at, std::vector<Mat3>& moments) {
  const PlaneWall& wall = sum_.wall();
  const Panel& panel = sources.surface.panels[e];
  const NodeTable& t = *panel.table;
  const Vec3 mirrored = wall.mirrored(at), below = wall.in_axes(mirrored);
  const PointTable& table = sources.surface.near_field.rule(e, mirrored, {});
  const std::vector<double> x = turned(wall, &sources.surface.bezier[panel.first_bezier], t.n_bernstein, true);
  std::vector<Pack>& scratch = scratch_.mine();
  scratch.resize(static_cast<std::size_t>(9) * table.packs());
  std::vector<double> own(static_cast<std::size_t>(9) * t.n_bernstein);
  switch (sources.kernel()) {
    case LayerKernel::single_layer:
      image_single_moments(table, x.data(), sources.area_weights_of(e, table, nullptr), below.data(), scratch.data(), own.data());
      break;
    case LayerKernel::double_layer: image_double_moments(table, x.data(), below.data(), scratch.data(), own.data()); break;
  }
  sources.counts.mine().near += table.points;
  moments.resize(static_cast<std::size_t>(t.n_bernstein));
  for (std::size_t b = 0; b < moments.size(); ++b)
    moments[b] = sources.factor(e) *
                 (wall.axes().transpose() * Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&own[9 * b]) * wall.axes());
}

bool WallImages::add_row(LayerSources& sources, const Vec3& x0, std::vector<Mat3>& block) {
  const Panels& panels = sources.surface.panels;
  std::vector<Mat3> moments;
  for (int e = 0; e < panels.size(); ++e) {
    panel_moments(sources, e, x0, moments);
    const double* extraction = panels.extraction(e);
    for (int p = 0; p < panels[e].functions; ++p, extraction += moments.size()) {
      Mat3 of_point = Mat3::Zero();
      for (std::size_t b = 0; b < moments.size(); ++b) of_point += extraction[b] * moments[b];
      block[static_cast<std::size_t>(panels.points(e)[p])] += of_point;
    }
  }
  return true;
}

}  // namespace tanktread::stokes
