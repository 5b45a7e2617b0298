// Contribution of a plane wall to a layer: the far sum over the images of the layer's nodes in the wall, and near-singular quadrature on panels that
// are close to the mirror image of a target.

#include <cassert>

#include "quadrature/gauss.hpp"
#include "stokes/kernels/image_kernel.hpp"
#include "stokes/layer.hpp"

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

}  // namespace

void Layer::set_wall(const PlaneWall& wall) {
  assert(!lattice_.cell && !shared() && "a wall is told before far sums are shared");
  const auto kind = single() ? ImageSum::Kind::forces : ImageSum::Kind::stresslets;
  images_.emplace(kind, wall, tree_ ? std::optional(share_of_clusters * surface_.options.tolerance) : std::nullopt);
  surface_.repeat();
  measure_.reset();
}

/// Adds the far sum over the images in the wall. For a double layer this is sum_k T^I (f - m) n - (sum_k T^I n)(f0 - m) over the nodes k, with the
/// image stresslet T^I (2.36), the mean m of the density f, and the constant f0 that is subtracted from f at the target.
void Layer::add_images(const Targets& targets, Net& u) {
  {
    const auto clock = phases_.time("images in the wall");
    std::vector<Vec3> at;
    std::vector<int> wanted;
    for (const int i : targets.in_tree) at.emplace_back(targets.at.row(i).transpose());
    for (const int i : targets.far_rows) wanted.push_back(static_cast<int>(std::ranges::lower_bound(targets.in_tree, i) - targets.in_tree.begin()));
    const bool others = images_->want(std::move(at), std::move(wanted));
    Net sums;
    if (single()) {
      sums = images_->sum(density_);
    } else {
      const Vec3 mean = mean_density();
      if (others) take_image_stress();
      take_moments(mean);
      sums = images_->sum(moment_);
      for (std::size_t k = 0; k < targets.far_rows.size(); ++k)
        sums.row(static_cast<Eigen::Index>(k)) -= (image_stress_[k] * (targets.f0.row(targets.far_rows[k]).transpose() - mean)).transpose();
    }
    evaluations_.far += images_->interactions();
    for (std::size_t k = 0; k < targets.far_rows.size(); ++k) u.row(targets.far_rows[k]) += sums.row(static_cast<Eigen::Index>(k));
  }
  add_near_images(targets, u);
}

/// Computes the matrices image_stress_, one per target: column c is the far sum of the double layer over the images in the wall for the constant
/// density e_c (unit vector c).
void Layer::take_image_stress() {
  for (int c = 0; c < 3; ++c) {
    take_constant_moments(c);
    const Net sums = images_->sum(moment_);
    image_stress_.resize(static_cast<std::size_t>(sums.rows()));
    for (std::size_t k = 0; k < image_stress_.size(); ++k) image_stress_[k].col(c) = sums.row(static_cast<Eigen::Index>(k)).transpose();
    evaluations_.far += images_->interactions();
  }
}

void Layer::add_near_images(const Targets& targets, Net& u) {
  const auto clock = phases_.time("near images");
  for (const int i : targets.rows) {
    const Vec3 at = targets.at.row(i).transpose(), mirrored = images_->wall().mirrored(at);
    for (const int e : surface_.near(mirrored, {})) {
      const PointTable& table = surface_.near_field.rule(e, mirrored, {});
      u.row(i) += beyond_image_sum(e, table, mirrored, at, targets.f0.row(i)).transpose();
    }
  }
}

/// Returns the contribution of the image of panel e in the wall by the near-singular rule `table`, minus the contribution of this image to the far
/// sum.
Vec3 Layer::beyond_image_sum(int e, const PointTable& table, const Vec3& mirrored, const Vec3& at, const Vec3& f0) {
  const PlaneWall& wall = images_->wall();
  const Panel& panel = surface_.panels[e];
  const int n_b = panel.table->n_bernstein, n = panel.table->n_nodes, first = panel.first_node;
  const std::vector<double> x = turned(wall, &surface_.bezier[panel.first_bezier], n_b, true);
  const std::vector<double> f = turned(wall, &bezier_f_[panel.first_bezier], n_b, false);
  const Vec3 below = wall.in_axes(mirrored), value = wall.axes() * f0;
  evaluations_.near += table.points + n;
  Vec3 better;
  Charges nodes{n, nullptr, nullptr, nullptr, {}};
  std::vector<double> carried[6];
  if (single()) {
    image_single_sum(table, x.data(), f.data(), area_weights_of(e, table, nullptr), below.data(), better.data());
    for (std::size_t c = 0; c < 3; ++c) nodes.q[c] = &density_[c][first];
  } else {
    image_double_sum(table, x.data(), f.data(), below.data(), value.data(), better.data());
    for (std::size_t s = 0; s < 6; ++s) {
      const auto [i, j] = stresses[s];
      for (int k = first; k < first + n; ++k)
        carried[s].push_back(((density_[i][k] - f0[i]) * normal_[j][k] + (density_[j][k] - f0[j]) * normal_[i][k]) / 2);
      nodes.q[s] = carried[s].data();
    }
  }
  return factor(e) * (wall.axes().transpose() * better) - images_->sum(nodes, first, at);
}

/// Computes the moments of the image of panel e at the target `at`: one matrix per Bernstein polynomial, in the laboratory axes, including the factor
/// k_p (2.1) of the panel.
void Layer::image_moments(int e, const Vec3& at, std::vector<Mat3>& moments) {
  const PlaneWall& wall = images_->wall();
  const Panel& panel = surface_.panels[e];
  const NodeTable& t = *panel.table;
  const Vec3 mirrored = wall.mirrored(at), below = wall.in_axes(mirrored);
  const PointTable& table = surface_.near_field.rule(e, mirrored, {});
  const std::vector<double> x = turned(wall, &surface_.bezier[panel.first_bezier], t.n_bernstein, true);
  scratch_.resize(static_cast<std::size_t>(9) * table.packs());
  std::vector<double> own(static_cast<std::size_t>(9) * t.n_bernstein);
  if (single())
    image_single_moments(table, x.data(), area_weights_of(e, table, nullptr), below.data(), scratch_.data(), own.data());
  else
    image_double_moments(table, x.data(), below.data(), scratch_.data(), own.data());
  evaluations_.near += table.points;
  moments.resize(static_cast<std::size_t>(t.n_bernstein));
  for (std::size_t b = 0; b < moments.size(); ++b)
    moments[b] = factor(e) * (wall.axes().transpose() * Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&own[9 * b]) * wall.axes());
}

/// Adds the contribution of the mirror images of the panels in the plane wall to the matrix rows `a` of the targets. For a double layer at sites,
/// this includes the term of (2.2) that subtracts the density at the site.
template <class Real>
void Layer::add_image_rows(std::span<const int> targets, const Net* at, Rows<Real>& a) {
  const Panels& panels = surface_.panels;
  std::vector<Mat3> moments;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const Vec3 x0 = at ? Vec3(at->row(targets[k]).transpose()) : surface_.site(targets[k]);
    const auto row = 3 * static_cast<Eigen::Index>(k);
    Mat3 total = Mat3::Zero();
    for (int e = 0; e < panels.size(); ++e) {
      image_moments(e, x0, moments);
      const double* extraction = panels.extraction(e);
      for (int p = 0; p < panels[e].functions; ++p, extraction += moments.size()) {
        Mat3 of_point = Mat3::Zero();
        for (std::size_t b = 0; b < moments.size(); ++b) of_point += extraction[b] * moments[b];
        a.template block<3, 3>(row, 3 * panels.points(e)[p]) += (over_8_pi * of_point).template cast<Real>();
        total += of_point;
      }
    }
    if (single() || at) continue;
    const auto [panel, basis] = surface_.self_field.basis(targets[k], panels);
    for (int b = 0; b < basis.size(); ++b)
      a.template block<3, 3>(row, 3 * panels.points(panel)[b]) -= (over_8_pi * basis[b] * total).template cast<Real>();
  }
}

template void Layer::add_image_rows(std::span<const int> targets, const Net* at, Rows<float>& a);
template void Layer::add_image_rows(std::span<const int> targets, const Net* at, Rows<double>& a);

}  // namespace tanktread::stokes
