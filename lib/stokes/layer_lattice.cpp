// Images of a layer's surfaces on a lattice.

#include <algorithm>
#include <iterator>
#include <vector>

#include "stokes/layer.hpp"

namespace tanktread::stokes {
namespace {

/// Tolerance for the sum over the images that are not near, divided by the tolerance of the layer. The ratio is below 1 because the loads are in
/// equilibrium, so that velocities are small compared with the sum of the magnitudes of their terms (as in TreeSum).
constexpr double share_of_rest = 0.1;

}  // namespace

void Layer::repeat(const PeriodicCell& cell, const Repetition& how) {
  constexpr int least_images = 27;
  if (lattice_.cell && *lattice_.cell == cell) return;
  if (!lattice_.cell) surface_.repeat();
  if (!tree_ && sums_by_tree(least_images * n_nodes(), surface_.options)) tree_.emplace(tree_tolerance(), precision());
  lattice_.cell = cell, lattice_.how = how;
  lattice_.near = cell.around({2, 2, 2});
  measure_.reset();
}

void Layer::place_in_cell() {
  std::array<Vec3, 2> extent = lattice_.how.across;
  for (int e = 0; e < surface_.panels.size(); ++e) {
    const int n = surface_.panels[e].table->n_bernstein;
    const double* x = &surface_.bezier[surface_.panels[e].first_bezier];
    for (int b = 0; b < n; ++b) {
      const Vec3 s = lattice_.cell->coordinates({x[b], x[n + b], x[2 * n + b]});
      extent[0] = extent[0].cwiseMin(s), extent[1] = extent[1].cwiseMax(s);
    }
  }
  if (!lattice_.sum || !(lattice_.sum->cell() == *lattice_.cell) || !lattice_.sum->suits(extent)) {
    const auto kind = single() ? PeriodicKernel::Kind::stokeslet : PeriodicKernel::Kind::stresslet;
    lattice_.sum.emplace(kind, *lattice_.cell, share_of_rest * surface_.options.tolerance, extent);
    if (tree_) tree_->repeat(lattice_.sum->images());
  }
  lattice_.rest_at.clear();
  for (auto& component : lattice_.node) component.resize(static_cast<std::size_t>(n_nodes()));
  for (std::size_t k = 0; k < lattice_.node[0].size(); ++k) {
    const Vec3 x = lattice_.sum->wrapped({surface_.node[0][k], surface_.node[1][k], surface_.node[2][k]});
    for (int c = 0; c < 3; ++c) lattice_.node[c][k] = x[c];
  }
}

/// Returns the positions of the targets `rows` for the far sums. On a lattice, these positions are wrapped into the cell.
std::vector<Vec3> Layer::far_targets(const Targets& targets, std::span<const int> rows) const {
  std::vector<Vec3> at = rows_of(targets.at, rows);
  if (lattice_.cell)
    for (Vec3& x : at) x = lattice_.sum->wrapped(x);
  return at;
}

/// Subtracts the contribution of the surfaces from the far sum at targets to which only images contribute. The far sum cannot omit the surfaces,
/// because each node is wrapped into the cell separately, so that the wrapped nodes of one surface may belong to different images.
void Layer::subtract_itself(const Targets& targets, Net& u) {
  const auto clock = phases_.time("far");
  std::vector<int> rows;
  std::ranges::copy_if(targets.far_rows, std::back_inserter(rows), [&](int i) { return i >= lattice_.images_only; });
  if (rows.empty()) return;
  const std::vector<Vec3> at = rows_of(targets.at, rows), f0 = rows_of(targets.f0, rows);
  Net sums(rows.size(), 3);
  single() ? far_sums(charges(surface_.node, density_), at, sums.data(), precision())
           : far_sums(stresslets(surface_.node, density_, normal_), at, f0, sums.data(), precision());
  for (std::size_t k = 0; k < at.size(); ++k) u.row(rows[k]) -= sums.row(static_cast<Eigen::Index>(k));
  evaluations_.far += static_cast<long long>(at.size()) * n_nodes();
}

/// Adds the contribution of the images that are not in the far sum, and for a double layer with three periods the pressure of (2.28).
void Layer::add_rest(const Targets& targets, Net& u) {
  const auto clock = phases_.time("rest of the lattice");
  const std::vector<Vec3> at = far_targets(targets, targets.rows);
  Net sums = Net::Zero(static_cast<Eigen::Index>(at.size()), 3);
  if (single()) {
    lattice_.sum->add_rest(charges(lattice_.node, density_), at, sums.data());
  } else {
    const Vec3 mean = mean_density();
    if (at != lattice_.rest_at) place_rest(at);
    take_moments(mean);
    lattice_.sum->add_rest(charges(lattice_.node, moment_), at, sums.data());
    if (lattice_.cell->n() == 3) sums.rowwise() += pressure_along().transpose();
    for (std::size_t k = 0; k < at.size(); ++k) {
      const Vec3 value = targets.f0.row(targets.rows[k]).transpose();
      sums.row(static_cast<Eigen::Index>(k)) -= (lattice_.rest_stress[k] * (value - mean)).transpose();
    }
  }
  for (std::size_t k = 0; k < at.size(); ++k) u.row(targets.rows[k]) += sums.row(static_cast<Eigen::Index>(k));
}

/// Computes the double layer of constant unit densities due to the images that are not in the far sum, at the targets `at`, one column per component
/// of the density. Each surface has images in the far sum and others that are not. Therefore neither the far sum nor this double layer vanishes for a
/// constant density.
void Layer::place_rest(const std::vector<Vec3>& at) {
  lattice_.rest_at = at;
  lattice_.rest_stress.assign(at.size(), Mat3::Zero());
  for (int c = 0; c < 3; ++c) {
    take_constant_moments(c);
    Net sums = Net::Zero(static_cast<Eigen::Index>(at.size()), 3);
    lattice_.sum->add_rest(charges(lattice_.node, moment_), at, sums.data());
    if (lattice_.cell->n() == 3) sums.rowwise() += pressure_along().transpose();
    for (std::size_t k = 0; k < at.size(); ++k) lattice_.rest_stress[k].col(c) = sums.row(static_cast<Eigen::Index>(k)).transpose();
  }
}

/// Returns the contribution of the additional pressure of (2.28) to the double layer, -(8 pi/V) sum_p k_p int_p (f.n) (x - x_p) dG, for the density f
/// whose moments are stored in moment_. x_p is the mean of the nodes of surface p, and k_p the factor of (2.2).
Vec3 Layer::pressure_along() const {
  const auto number = [&](int e) { return static_cast<std::size_t>(surface_.near_field.surface(e)); };
  const auto place = [&](int k) { return Vec3(surface_.node[0][k], surface_.node[1][k], surface_.node[2][k]); };
  std::vector<Vec3> middle(static_cast<std::size_t>(surface_.near_field.n_surfaces()), Vec3::Zero());
  std::vector<int> nodes(middle.size(), 0);
  for (int e = 0; e < surface_.panels.size(); ++e)
    for (int k = 0; k < surface_.panels[e].table->n_nodes; ++k) middle[number(e)] += place(surface_.panels[e].first_node + k), ++nodes[number(e)];
  for (std::size_t p = 0; p < middle.size(); ++p) middle[p] /= nodes[p];
  Vec3 sum = Vec3::Zero();
  for (int e = 0; e < surface_.panels.size(); ++e)
    for (int k = surface_.panels[e].first_node; k < surface_.panels[e].first_node + surface_.panels[e].table->n_nodes; ++k)
      sum += (moment_[0][k] + moment_[1][k] + moment_[2][k]) * (place(k) - middle[number(e)]);
  return -1 / (over_8_pi * lattice_.cell->volume()) * sum;
}

}  // namespace tanktread::stokes
