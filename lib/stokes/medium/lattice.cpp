#include "stokes/medium/lattice.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace tanktread::stokes {
namespace {

/// Tolerance for the sum over the images that are not near, divided by the tolerance of the layer. The ratio is below 1 because the loads are in
/// equilibrium, so that velocities are small compared with the sum of the magnitudes of their terms (as in TreeSum).
constexpr double share_of_remainder = 0.1;

/// Largest number of sites for which rows are assembled site by site.
constexpr std::size_t few_sites = 4;

/// Returns int f N_B dGamma for every control point B, from the values of f at the far nodes.
Eigen::VectorXd integrals(const LayerSources& sources, const Eigen::VectorXd& f) {
  std::vector<double> weighted(sources.weight);
  for (std::size_t k = 0; k < weighted.size(); ++k) weighted[k] *= f[static_cast<Eigen::Index>(k)];
  return sources.moments(weighted);
}

PeriodicKernel::Kind periodic_kind(LayerKernel kernel) {
  switch (kernel) {
    case LayerKernel::single_layer: return PeriodicKernel::Kind::stokeslet;
    case LayerKernel::double_layer: return PeriodicKernel::Kind::stresslet;
  }
  throw std::logic_error("unknown LayerKernel");
}

}  // namespace

void Lattice::set_sources(const LayerSources& sources) {
  const LayerSurface& surface = sources.surface;
  std::array<Vec3, 2> extent = how_.target_range;
  for (int e = 0; e < surface.panels.size(); ++e) {
    const int n = surface.panels[e].table->n_bernstein;
    const double* x = &surface.bezier[surface.panels[e].first_bezier];
    for (int b = 0; b < n; ++b) {
      const Vec3 s = cell_.coordinates({x[b], x[n + b], x[2 * n + b]});
      extent[0] = extent[0].cwiseMin(s), extent[1] = extent[1].cwiseMax(s);
    }
  }
  if (!sum_ || !sum_->suits(extent)) {
    sum_.emplace(periodic_kind(sources.kernel()), cell_, share_of_remainder * surface.options.tolerance, extent);
  }
  remainder_at_.clear();
  for (auto& component : node_) component.resize(static_cast<std::size_t>(sources.n_nodes()));
  for (std::size_t k = 0; k < node_[0].size(); ++k) {
    const Vec3 x = sum_->wrapped({surface.node[0][k], surface.node[1][k], surface.node[2][k]});
    for (int c = 0; c < 3; ++c) node_[c][k] = x[c];
  }
}

void Lattice::add(LayerSources& sources, const LayerTargets& targets, Net& u) {
  subtract_surfaces(sources, targets, u);
  add_remainder(sources, targets, u);
}

/// Subtracts the contribution of the surfaces from the far sum at targets to which only images contribute. The far sum cannot omit the surfaces,
/// because each node is wrapped into the cell separately, so that the wrapped nodes of one surface may belong to different images.
void Lattice::subtract_surfaces(LayerSources& sources, const LayerTargets& targets, Net& u) const {
  const auto clock = sources.phases.time("far");
  std::vector<int> rows;
  std::ranges::copy_if(targets.far_rows, std::back_inserter(rows), [&](int i) { return i >= targets.first_image_row; });
  if (rows.empty()) return;
  const Net sums = sources.direct_sum(sources.surface.node, rows_of(targets.at, rows), rows_of(targets.f0, rows));
  for (std::size_t k = 0; k < rows.size(); ++k) u.row(rows[k]) -= sums.row(static_cast<Eigen::Index>(k));
}

/// Adds the contribution of the images that are not near (see PeriodicSum). If there are three periods, also adds the pressure of (2.28) to a double
/// layer.
void Lattice::add_remainder(LayerSources& sources, const LayerTargets& targets, Net& u) {
  const auto clock = sources.phases.time("rest of the lattice");
  std::vector<Vec3> at = rows_of(targets.at, targets.rows);
  for (Vec3& x : at) x = wrapped(x);
  Net sums = Net::Zero(static_cast<Eigen::Index>(at.size()), 3);
  switch (sources.kernel()) {
    case LayerKernel::single_layer: sum_->add_remainder(charges(node_, sources.density), at, sums.data()); break;
    case LayerKernel::double_layer: add_regularised_stresslets(sources, targets, at, sums); break;
  }
  for (std::size_t k = 0; k < at.size(); ++k) u.row(targets.rows[k]) += sums.row(static_cast<Eigen::Index>(k));
}

/// Adds the double layer of the images that are not near at the targets `at`, after the constant f0 of each target is subtracted from the density.
void Lattice::add_regularised_stresslets(LayerSources& sources, const LayerTargets& targets, const std::vector<Vec3>& at, Net& sums) {
  const Vec3 mean = sources.mean_density();
  if (at != remainder_at_) set_remainder_targets(sources, at);
  add_stresslets(sources, sources.stresslet_moments(mean), at, sums);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Vec3 value = targets.f0.row(targets.rows[k]).transpose();
    sums.row(static_cast<Eigen::Index>(k)) -= (remainder_stress_[k] * (value - mean)).transpose();
  }
}

/// Adds the sum over the images that are not near, of stresslets with these moments, at the targets `at`.
void Lattice::add_stresslets(const LayerSources& sources, const Moments& moments, const std::vector<Vec3>& at, Net& sums) {
  sum_->add_remainder(charges(node_, moments), at, sums.data());
  if (cell_.n() == 3) sums.rowwise() += pressure_along(sources, moments).transpose();
}

/// Computes remainder_stress_ at the targets `at`: the double layer of a constant unit density on all images that are not near, one column per
/// component of the density. Each node is wrapped into the cell separately, so that the near images can contain a part of a surface only. Therefore
/// neither the double layer of the near images nor that of the other images vanishes for a constant density.
void Lattice::set_remainder_targets(LayerSources& sources, const std::vector<Vec3>& at) {
  remainder_at_ = at;
  remainder_stress_.assign(at.size(), Mat3::Zero());
  for (int c = 0; c < 3; ++c) {
    Net sums = Net::Zero(static_cast<Eigen::Index>(at.size()), 3);
    add_stresslets(sources, sources.stresslet_moments_of_constant(c), at, sums);
    for (std::size_t k = 0; k < at.size(); ++k) remainder_stress_[k].col(c) = sums.row(static_cast<Eigen::Index>(k)).transpose();
  }
}

/// Returns the contribution of the additional pressure of (2.28) to the double layer, -(8 pi/V) sum_p k_p int_p (f.n) (x - x_p) dGamma, for the
/// density f with these moments. x_p is the mean of the nodes of surface p, and k_p the factor of (2.2).
Vec3 Lattice::pressure_along(const LayerSources& sources, const Moments& moments) const {
  const LayerSurface& surface = sources.surface;
  const auto number = [&](int e) { return static_cast<std::size_t>(surface.near_field.surface(e)); };
  const auto place = [&](int k) { return Vec3(surface.node[0][k], surface.node[1][k], surface.node[2][k]); };
  std::vector<Vec3> middle(static_cast<std::size_t>(surface.near_field.n_surfaces()), Vec3::Zero());
  std::vector<int> nodes(middle.size(), 0);
  for (int e = 0; e < surface.panels.size(); ++e)
    for (int k = 0; k < surface.panels[e].table->n_nodes; ++k)
      middle[number(e)] += place(surface.panels[e].first_node + k), ++nodes[number(e)];
  for (std::size_t p = 0; p < middle.size(); ++p) middle[p] /= nodes[p];
  Vec3 sum = Vec3::Zero();
  for (int e = 0; e < surface.panels.size(); ++e)
    for (int k = surface.panels[e].first_node; k < surface.panels[e].first_node + surface.panels[e].table->n_nodes; ++k)
      sum += (moments[0][k] + moments[1][k] + moments[2][k]) * (place(k) - middle[number(e)]);
  return -1 / (over_8_pi * cell_.volume()) * sum;
}

/// Adds the sum over the images that are not near to the rows `a` of the matrix. The kernel is interpolated: its values between the interpolation
/// nodes are multiplied by the Lagrange polynomials L_a at the sites and by the integrals of L_a N_B over the surface.
void Lattice::add_remainder(const LayerSources& sources, std::span<const int> sites, Rows<double>& a) const {
  std::vector<Vec3> at, nodes;
  for (const int i : sites) at.push_back(wrapped(sources.surface.site(i)));
  for (std::size_t k = 0; k < node_[0].size(); ++k) nodes.emplace_back(node_[0][k], node_[1][k], node_[2][k]);
  if (at.size() <= few_sites) return add_remainder_site_by_site(sources, at, nodes, a);
  const Eigen::MatrixXd to = sum_->lagrange(at);
  Eigen::MatrixXd from = sum_->lagrange(nodes), basis(from.cols(), sources.surface.n_points);
  for (Eigen::Index k = 0; k < from.cols(); ++k) basis.row(k) = integrals(sources, from.col(k)).transpose();
  for (int c = 0; c < kernel_entries; ++c) {
    const auto [i, j] = upper[c];
    const Eigen::MatrixXd part = over_8_pi * (to * (sum_->between_nodes(c) * basis));
    for (Eigen::Index k = 0; k < part.rows(); ++k)
      for (Eigen::Index b = 0; b < part.cols(); ++b) {
        a(3 * k + i, 3 * b + j) += part(k, b);
        if (i != j) a(3 * k + j, 3 * b + i) += part(k, b);
      }
  }
}

/// Does the same as add_remainder(), in less time for few sites. The kernel is symmetric: its values at the far nodes are the velocities there due to
/// unit forces at the site.
void Lattice::add_remainder_site_by_site(const LayerSources& sources, const std::vector<Vec3>& at, const std::vector<Vec3>& nodes,
                                         Rows<double>& a) const {
  for (std::size_t k = 0; k < at.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const Vec3 force = Vec3::Unit(i);
      Net velocity = Net::Zero(static_cast<Eigen::Index>(nodes.size()), 3);
      sum_->add_remainder({1, &at[k][0], &at[k][1], &at[k][2], {&force[0], &force[1], &force[2]}}, nodes, velocity.data());
      for (int j = 0; j < 3; ++j) {
        const Eigen::VectorXd part = over_8_pi * integrals(sources, velocity.col(j));
        for (Eigen::Index b = 0; b < part.size(); ++b) a(3 * static_cast<Eigen::Index>(k) + i, 3 * b + j) += part[b];
      }
    }
}

}  // namespace tanktread::stokes
