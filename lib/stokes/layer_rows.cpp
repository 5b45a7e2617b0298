// Assembly of matrix rows of a layer: far-field sums for sixteen targets at a time, near-singular and singular quadrature for one target at a time.
// Assembles complete rows, or only the blocks of near control points.

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <stdexcept>
#include <type_traits>

#include "base/indices.hpp"
#include "base/stop.hpp"
#include "stokes/closed_surface_identities.hpp"
#include "stokes/kernels/assembly_kernel.hpp"
#include "stokes/layer.hpp"

namespace tanktread::stokes {
namespace {

/// Values of the basis functions of some panels at the far nodes of these panels. Each basis function adds to the row of its control point in
/// RowSums::sums. The number of basis functions is padded to a multiple of `assembly_tile`. Padding, and basis functions of control points that are
/// not requested, add to a spare row.
template <class Real>
struct FarBasis {
  std::vector<int> panels, index;  ///< panels: panels with stored values. index: for each panel of the surface, its position in `panels`, or -1 if it
                                   ///< has no stored values
  std::vector<Real> values;
  std::vector<int> rows;
  std::vector<std::size_t> first_value, first_row;

  void clear(const Panels& all) {
    panels.clear(), values.clear(), rows.clear(), first_value.clear(), first_row.clear();
    index.assign(static_cast<std::size_t>(all.size()), -1);
  }

  void add(const Panels& all, int e, const std::vector<int>& row_of_point, int spare_row) {
    const NodeTable& t = *all[e].table;
    const int m = all[e].functions, padded = (m + assembly_tile - 1) / assembly_tile * assembly_tile;
    index[e] = static_cast<int>(panels.size());
    panels.push_back(e);
    first_value.push_back(values.size());
    first_row.push_back(rows.size());
    values.resize(values.size() + static_cast<std::size_t>(padded) * t.n_nodes, Real(0));
    for (int a = 0; a < m; ++a)  // plain loops instead of a matrix product, because their order of summation does not depend on memory alignment
      for (int b = 0; b < t.n_bernstein; ++b) {
        const Real share = static_cast<Real>(all.extraction(e)[t.n_bernstein * a + b]);
        const double* from = &t.value[static_cast<std::size_t>(t.n_nodes) * b];
        Real* to = &values[first_value.back() + static_cast<std::size_t>(t.n_nodes) * a];
        for (int k = 0; k < t.n_nodes; ++k) to[k] += share * static_cast<Real>(from[k]);
      }
    for (int a = 0; a < padded; ++a) rows.push_back(a < m ? row_of_point[all.points(e)[a]] : spare_row);
  }

  /// Returns the far nodes of the k-th panel. Does not set their weights and normals.
  PanelNodes<Real> nodes(const LayerSurface& surface, const std::vector<double> (&x)[3], std::size_t k) const {
    const Panel& p = surface.panels[panels[k]];
    PanelNodes<Real> nodes;
    nodes.n_nodes = p.table->n_nodes, nodes.functions = (p.functions + assembly_tile - 1) / assembly_tile * assembly_tile;
    nodes.x = &x[0][p.first_node], nodes.y = &x[1][p.first_node], nodes.z = &x[2][p.first_node];
    nodes.basis = &values[first_value[k]], nodes.rows = &rows[first_row[k]];
    return nodes;
  }
};

/// Adds the Bernstein moments of panel e, moments[m b + c] with m = kernel_entries, to the sums of one target: sums[n (m rows[A] + c)] for each basis
/// function A, with n = assembly_block.
template <class Real>
void add_moments(const Panels& panels, int e, const int* rows, const double* moments, Real* sums) {
  const int n_b = panels[e].table->n_bernstein;
  const Eigen::Map<const Rows<double>> extraction(panels.extraction(e), panels[e].functions, n_b);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, kernel_entries, Eigen::RowMajor>> moment(moments, n_b, kernel_entries);
  for (int a = 0; a < panels[e].functions; ++a) {
    const Eigen::Matrix<double, 1, kernel_entries> row = extraction.row(a).lazyProduct(moment);
    Real* to = sums + static_cast<std::ptrdiff_t>(kernel_entries * assembly_block) * rows[a];
    for (int c = 0; c < kernel_entries; ++c) to[assembly_block * c] += static_cast<Real>(row[c]);
  }
}

/// Writes the three rows of the matrix for one target: `sums` divided by 8 pi. `sums`: for each control point, the integrals of its basis function
/// times the kernel entries 11, 12, 13, 22, 23, 33.
template <class Real>
void write_rows(int row, int n_points, const Real* sums, Rows<Real>& a) {
  constexpr int entry[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  const Real scale = static_cast<Real>(over_8_pi);
  for (int i = 0; i < 3; ++i) {
    Real* to = &a(row + i, 0);
    const Real* from = sums;
    for (int p = 0; p < n_points; ++p, from += kernel_entries * assembly_block, to += 3)
      for (int j = 0; j < 3; ++j) to[j] = scale * from[assembly_block * entry[3 * i + j]];
  }
}

void sort_and_drop_repeated(std::vector<int>& numbers) {
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// Which copies of the surfaces contribute to assembled rows: the surfaces alone, with their displaced images, or only these images.
enum class Copies { surfaces, with_images, images };

Copies copies(const LayerMedium& medium) { return medium.rows_include_images() ? Copies::with_images : Copies::surfaces; }

/// Returns the displacements of the copies that contribute.
std::vector<Vec3> displacements(const LayerMedium& medium, Copies copies) {
  if (copies == Copies::surfaces) return {Vec3::Zero()};
  std::vector<Vec3> shifts = medium.panel_shifts();
  if (copies == Copies::images) std::erase_if(shifts, [](const Vec3& shift) { return shift.isZero(0); });
  return shifts;
}

/// Assembles the integrals of kernel times basis function, one per control point and kernel component, for up to sixteen targets at a time.
template <class Real>
class RowSums {
 public:
  /// `at`: positions of targets off the surfaces, one row per target; if null, the targets are sites.
  RowSums(LayerSources& sources, const LayerMedium& medium, const Net* at, Copies copies)
      : sources_(sources), medium_(medium), at_(at), copies_(copies), shifts_(displacements(medium, copies)) {}

  /// Returns the sums of a block of targets: element n (m row + c) + l, with n = assembly_block and m = kernel_entries, is the integral of kernel
  /// entry c (11, 12, 13, 22, 23, 33) times the basis function of control point `row`, at target l. `rows`: number of control points in `basis`.
  /// The result is valid until the next call by the same thread.
  std::vector<Real>& of(std::span<const int> targets, const FarBasis<Real>& basis, int rows) {
    Work& work = work_.mine();
    work.sums.assign(static_cast<std::size_t>(kernel_entries) * assembly_block * (rows + 1), Real(0));
    work.skip.assign(basis.panels.size(), 0u);
    for (int l = 0; l < static_cast<int>(targets.size()); ++l) add_close_panels(basis, targets[l], l, work);
    for (const Vec3& image : wrapped() ? medium_.node_shifts() : shifts_) {
      double place[3 * assembly_block];
      for (int l = 0; l < assembly_block; ++l) {
        const Vec3 x0 = place_of(targets[std::min<std::size_t>(l, targets.size() - 1)]);
        const Vec3 seen = (wrapped() ? medium_.wrapped(x0) : x0) - image;
        for (int c = 0; c < 3; ++c) place[assembly_block * c + l] = seen[c];
      }
      for (std::size_t k = 0; k < basis.panels.size(); ++k) add_far_panel(basis, k, place, static_cast<int>(targets.size()), work);
    }
    return work.sums;
  }

 private:
  struct Work {
    std::vector<Real> sums, kernel;
    std::vector<double> moments;
    std::vector<std::uint32_t> skip;
  };

  Vec3 place_of(int target) const { return at_ ? Vec3(at_->row(target)) : sources_.surface.site(target); }
  bool wrapped() const { return copies_ == Copies::with_images; }  // whether far sums use nodes that are moved into the cell

  /// Adds the corrections by near-singular and singular quadrature for one target. A displaced panel is corrected if it is close to the target. The
  /// far sum that is corrected contains the nodes of displaced panels. l: index of the target in its block of sixteen.
  void add_close_panels(const FarBasis<Real>& basis, int target, int l, Work& work) {
    LayerSurface& surface = sources_.surface;
    for (const Vec3& image : shifts_) {
      const Vec3 x0 = place_of(target) - image;
      const std::span<SelfPair> self_pairs = !at_ && image.isZero(0) ? surface.self_pairs(target) : std::span<SelfPair>();
      for (const int e : surface.near(x0, self_pairs))
        if (basis.index[e] >= 0) add_panel(basis, e, surface.near_field.rule(e, x0, self_pairs), nullptr, x0, l, work);
      for (SelfPair& pair : self_pairs)
        if (basis.index[pair.panel] >= 0) add_panel(basis, pair.panel, *pair.table, &pair, x0, l, work);
    }
  }

  void add_panel(const FarBasis<Real>& basis, int e, const PointTable& table, SelfPair* pair, const Vec3& x0, int l, Work& work) {
    const Panels& panels = sources_.surface.panels;
    const auto k = static_cast<std::size_t>(basis.index[e]);
    work.moments.resize(static_cast<std::size_t>(kernel_entries) * panels[e].table->n_bernstein);
    if (copies_ != Copies::surfaces) {
      sources_.moments_beyond_far_sum(e, table, pair, x0, work.moments.data());
    } else {
      work.skip[k] |= 1u << l;
      sources_.panel_moments(e, table, pair, x0, work.moments.data());
    }
    add_moments(panels, e, &basis.rows[basis.first_row[k]], work.moments.data(), &work.sums[l]);
    (pair ? sources_.counts.mine().self : sources_.counts.mine().near) += table.points;
  }

  void add_far_panel(const FarBasis<Real>& basis, std::size_t k, const double* place, int n_targets, Work& work) {
    const int first = sources_.surface.panels[basis.panels[k]].first_node;
    PanelNodes<Real> nodes = basis.nodes(sources_.surface, wrapped() ? medium_.nodes(sources_) : sources_.surface.node, k);
    switch (sources_.kernel()) {
      case LayerKernel::single_layer: nodes.weight = &sources_.weight[first]; break;
      case LayerKernel::double_layer:
        for (int c = 0; c < 3; ++c) nodes.normal[c] = &sources_.normal[c][first];
        break;
    }
    work.kernel.resize(static_cast<std::size_t>(kernel_entries) * assembly_block * nodes.n_nodes);
    far_moments(nodes, place, work.skip[k], work.kernel.data(), work.sums.data());
    sources_.counts.mine().far += static_cast<long long>(n_targets) * nodes.n_nodes;
  }

  LayerSources& sources_;
  const LayerMedium& medium_;
  const Net* at_;
  Copies copies_;
  std::vector<Vec3> shifts_;  // displacements of the panels that contribute
  PerThread<Work> work_;
};

/// Calls use(some, first) for the blocks of sixteen targets, on all threads, while the pairs of these targets and panels have singular rules.
/// `some` are the targets from index `first` on.
template <class Use>
void each_target_block(LayerSurface& surface, std::span<const int> targets, bool sites, const Use& use) {
  constexpr std::size_t block = assembly_block;
  const auto blocks = [&](std::span<const int> part, std::size_t begin) {
    each_block(part.size(), block, [&](std::size_t first, std::size_t last) {
      stop_here();
      use(part.subspan(first, last - first), begin + first);
    });
  };
  sites ? surface.with_rules(targets, block, blocks) : blocks(targets, 0);
}

/// Subtracts the term with the density f(x_i) at the site x_i from the double layer (2.2). With the sums A_iC of all control points C, this subtracts
/// N_B(x_i) sum_C A_iC from the sum A_iB of each control point B. The subtracted term is thereby integrated by the same quadrature rules as the term
/// with f(x).
template <class Real>
void subtract_density_at_site(const LayerSources& sources, int site, Real* sums) {
  double total[kernel_entries] = {};
  for (int p = 0; p < sources.surface.n_points; ++p)
    for (int c = 0; c < kernel_entries; ++c) total[c] += sums[assembly_block * (kernel_entries * static_cast<std::ptrdiff_t>(p) + c)];
  const auto [panel, basis] = sources.surface.self_field.basis(site, sources.surface.panels);
  for (int b = 0; b < basis.size(); ++b)
    for (int c = 0; c < kernel_entries; ++c)
      sums[assembly_block * (kernel_entries * static_cast<std::ptrdiff_t>(sources.surface.panels.points(panel)[b]) + c)] -=
          static_cast<Real>(basis[b] * total[c]);
}

/// Adds the terms of the medium other than displaced images to the matrix rows `a` of the targets. For a double layer at sites, this includes the
/// term of (2.2) that subtracts the density at the site.
template <class Real>
void add_medium_rows(LayerSources& sources, LayerMedium& medium, std::span<const int> targets, const Net* at, Rows<Real>& a) {
  const LayerSurface& surface = sources.surface;
  const auto add = [&](std::size_t k) {
    stop_here();
    std::vector<Mat3> block(static_cast<std::size_t>(surface.n_points), Mat3::Zero());
    if (!medium.add_row(sources, at ? Vec3(at->row(targets[k]).transpose()) : surface.site(targets[k]), block)) return false;
    if (properties(sources.kernel()).subtracts_density && !at) {
      Mat3 total = Mat3::Zero();
      for (const Mat3& of_point : block) total += of_point;
      const auto [panel, basis] = surface.self_field.basis(targets[k], surface.panels);
      for (int b = 0; b < basis.size(); ++b) block[static_cast<std::size_t>(surface.panels.points(panel)[b])] -= basis[b] * total;
    }
    for (std::size_t p = 0; p < block.size(); ++p)
      a.template block<3, 3>(3 * static_cast<Eigen::Index>(k), 3 * static_cast<Eigen::Index>(p)) +=
          (over_8_pi * block[p]).template cast<Real>();
    return true;
  };
  if (targets.empty() || !add(0)) return;
  each_item(targets.size() - 1, [&](std::size_t k) { add(k + 1); }, medium.any_thread());
}

/// Assembles the rows of the targets without the terms of the medium other than displaced images.
template <class Real>
void assemble_copies(LayerSources& sources, const LayerMedium& medium, std::span<const int> targets, const Net* at, Copies copies, Rows<Real>& a) {
  const auto clock = sources.phases.time("assembly");
  const Panels& panels = sources.surface.panels;
  const int n = sources.surface.n_points;
  RowSums<Real> rows(sources, medium, at, copies);
  const std::vector<int> row_of_point = indices(n);
  FarBasis<Real> basis;
  basis.clear(panels);
  for (int e = 0; e < panels.size(); ++e) basis.add(panels, e, row_of_point, n);
  a.resize(3 * static_cast<Eigen::Index>(targets.size()), 3 * n);
  each_target_block(sources.surface, targets, !at, [&](std::span<const int> some, std::size_t first) {
    std::vector<Real>& sums = rows.of(some, basis, n);
    for (std::size_t l = 0; l < some.size(); ++l) {
      if (properties(sources.kernel()).subtracts_density && !at) subtract_density_at_site(sources, some[l], &sums[l]);
      write_rows(3 * static_cast<int>(first + l), n, &sums[l], a);
    }
  });
}

template <class Real>
void assemble_rows(LayerSources& sources, LayerMedium& medium, std::span<const int> targets, const Net* at, Rows<Real>& a) {
  assemble_copies(sources, medium, targets, at, copies(medium), a);
  add_medium_rows(sources, medium, targets, at, a);
  if (!at && sources.desingularised()) subtract_identities(sources, targets, a);
}

}  // namespace

template <class Real>
void Layer::assemble(std::span<const int> sites, Rows<Real>& a) {
  assemble_rows(sources_, *medium_, sites, nullptr, a);
  if (!medium_->rows_include_images()) return;
  switch (sources_.kernel()) {
    case LayerKernel::single_layer: break;
    case LayerKernel::double_layer: return;  // its rows include only the near images
  }
  if constexpr (std::is_same_v<Real, double>) {
    const auto clock = sources_.phases.time("assembly");
    medium_->add_remainder(sources_, sites, a);
  } else {
    throw std::logic_error("the images of a lattice are added to rows in double precision only");
  }
}
template <class Real>
void Layer::assemble(const Net& at, std::span<const int> targets, Rows<Real>& a) {
  assemble_rows(sources_, *medium_, targets, &at, a);
}
template void Layer::assemble(std::span<const int> sites, Rows<float>& a);
template void Layer::assemble(std::span<const int> sites, Rows<double>& a);
template void Layer::assemble(const Net& at, std::span<const int> targets, Rows<float>& a);
template void Layer::assemble(const Net& at, std::span<const int> targets, Rows<double>& a);

void Layer::assemble_images(const Net& at, std::span<const int> targets, Rows<float>& a) {
  assemble_copies(sources_, *medium_, targets, &at, Copies::images, a);
}

void Layer::assemble(std::span<const int> sites, const NearPoints& near, std::vector<double>& entries) {
  assert(!properties(sources_.kernel()).subtracts_density);
  const auto clock = sources_.phases.time("assembly");
  constexpr std::size_t block = assembly_block;
  const Panels& panels = sources_.surface.panels;
  std::vector<std::vector<int>> panels_of(static_cast<std::size_t>(sources_.surface.n_points));
  for (int e = 0; e < panels.size(); ++e)
    for (int a = 0; a < panels[e].functions; ++a) panels_of[panels.points(e)[a]].push_back(e);
  RowSums<double> rows(sources_, *medium_, nullptr, copies(*medium_));
  struct Work {
    std::vector<int> row_of_point, wanted, with_wanted;
    FarBasis<double> basis;
  };
  PerThread<Work> works;
  entries.resize(kernel_entries * near.point.size());
  each_target_block(sources_.surface, sites, true, [&](std::span<const int> some, std::size_t first) {
    auto& [row_of_point, wanted, with_wanted, basis] = works.mine();
    wanted.assign(near.point.begin() + static_cast<std::ptrdiff_t>(near.first[first]),
                  near.point.begin() + static_cast<std::ptrdiff_t>(near.first[first + some.size()]));
    sort_and_drop_repeated(wanted);
    const int spare = static_cast<int>(wanted.size());
    row_of_point.assign(static_cast<std::size_t>(sources_.surface.n_points), spare);
    for (int k = 0; k < spare; ++k) row_of_point[wanted[k]] = k;
    with_wanted.clear();
    for (const int point : wanted) with_wanted.insert(with_wanted.end(), panels_of[point].begin(), panels_of[point].end());
    sort_and_drop_repeated(with_wanted);
    basis.clear(panels);
    for (const int e : with_wanted) basis.add(panels, e, row_of_point, spare);
    const std::vector<double>& sums = rows.of(some, basis, spare);
    for (std::size_t l = 0; l < some.size(); ++l)
      for (std::size_t j = near.first[first + l]; j < near.first[first + l + 1]; ++j)
        for (std::size_t c = 0; c < kernel_entries; ++c)
          entries[kernel_entries * j + c] =
              over_8_pi * sums[block * (kernel_entries * static_cast<std::size_t>(row_of_point[near.point[j]]) + c) + l];
  });
  if (sources_.desingularised()) subtract_identities(sources_, sites, near, entries);
}

}  // namespace tanktread::stokes
