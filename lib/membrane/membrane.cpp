#include "membrane/membrane.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/indices.hpp"
#include "base/threads.hpp"
#include "membrane/packed.hpp"
#include "membrane/points_kernel.hpp"

namespace tanktread::membrane {
namespace {

constexpr std::size_t parts_kept = 3;       // number of element sets whose Part is stored: all elements, the rank-owned elements, and one more set
constexpr double compressed_below = -1e-9;  // tensions below this multiple of the modulus count as compression; tensions closer to 0 may be round-off

}  // namespace

/// A set of elements, sorted into batches for the packed kernels (one element per register lane), with the unstressed surface at the Gauss points.
struct Part {
  std::vector<int> elements;
  std::vector<Material> materials;  ///< materials of the surface. split_material() appends one material for each area elasticity that has its own
                                    ///< Gauss rule; an appended material has only this area elasticity
  std::vector<Law> whole;           ///< per material: complete law, from which tensions are computed. It includes the terms that split_material()
                                    ///< moves to another material
  std::vector<bool> sampled;        ///< per material: true if tensions are evaluated at its Gauss points. False for the shear part of a split law:
                                    ///< the Gauss points of its area part are used instead
  std::vector<Group> groups;
  std::vector<std::vector<ReferencePoint>> reference;  ///< per group: reference points; point q of batch k has the index n_gauss k + q
  std::vector<std::vector<Pack>> relaxed_curvature;    ///< per group: c0 of `Bending` at the Gauss points; empty without bending
  PointSums sums;                                      ///< sums over the batches of all groups

  Part(const spline::Space& space, const Net& unstressed, std::span<const int> list, int order, const Materials& of_surface);
  void split_material(const spline::Space& space, const Materials& of_surface, std::size_t m);

  /// A batch (elements in the lanes of one register) with the data of its n Gauss points. `g`: index of its group in `groups`. `first`: index of the
  /// first of these Gauss points in the arrays of this group, for example reference[g]. `c0`: curvature c0 of `Bending`; null without bending.
  struct Points {
    const Group& group;
    const Batch& batch;
    const Material& material;
    const Law& whole;  ///< complete law of the material, see Part::whole
    const ReferencePoint* reference;
    const Pack* c0;
    std::size_t g, first;
    int n;
  };
  /// Calls use(Points) for all batches: for one group after the other, on all threads. An element is in one batch of a group, and may be in several
  /// groups.
  template <class Use>
  void each_batch(const Use& use) const {
    for (std::size_t g = 0; g < groups.size(); ++g)
      each_item(groups[g].batches.size(), [&](std::size_t k) {
        const std::size_t first = k * groups[g].n_gauss();
        const Pack* c0 = relaxed_curvature[g].empty() ? nullptr : &relaxed_curvature[g][first];
        const int m = groups[g].material;
        use(Points{groups[g], groups[g].batches[k], materials[m], whole[m], &reference[g][first], c0, g, first, groups[g].n_gauss()});
      });
  }
  template <class Use>
  void each_bending_batch(const Use& use) const {
    each_batch([&](const Points& at) {
      if (at.c0) use(at);
    });
  }
  bool bends() const {
    return std::ranges::any_of(relaxed_curvature, [](const std::vector<Pack>& c0) { return !c0.empty(); });
  }

  /// Adds to the control points of `sum` the rows that use(Points, rows) sets for each batch (see transpose()). It returns false if they are zero.
  template <class Use>
  void add_rows(Net& sum, const Use& use) const {
    const auto rows = std::make_unique_for_overwrite<double[]>(3 * sums.n_rows());
    each_batch([&](const Points& at) {
      double* const own = &rows[3 * at.batch.row];
      if (!use(at, own)) std::fill_n(own, 3 * at.batch.used * at.batch.functions, 0.);
    });
    sums.add(rows.get(), sum);
  }
};

Part::Part(const spline::Space& space, const Net& unstressed, std::span<const int> list, int order, const Materials& of_surface)
    : elements(list.begin(), list.end()), materials(of_surface.all), groups(pack(space, list, order, of_surface.of_element)) {
  for (const Material& material : materials) whole.push_back(material.law);
  sampled.assign(materials.size(), true);
  for (std::size_t m = 0; m < of_surface.all.size(); ++m)
    if (of_surface.all[m].area_order > 0) split_material(space, of_surface, m);
  Pack a[15 * max_gauss];
  for (const Group& group : groups) {
    const int n = group.n_gauss();
    const Bending& bending = materials[group.material].bending;
    std::vector<ReferencePoint>& points = reference.emplace_back(n * group.batches.size());
    std::vector<Pack>& curvature = relaxed_curvature.emplace_back(bending.modulus > 0 ? points.size() : 0, Pack{});
    for (Pack& c0 : curvature) std::ranges::fill(c0.lanes, bending.spontaneous_curvature);
    for (std::size_t k = 0; k < group.batches.size(); ++k) {
      const Batch& batch = group.batches[k];
      ReferencePoint* first = &points[k * n];
      tangents(group, batch, unstressed, a);
      reference_points(n, batch.used, a, group.weight.data(), first);
      if (curvature.empty() || !bending.curved_when_relaxed) continue;
      jets(group, batch, unstressed, a);
      curvatures(n, a, &curvature[k * n]);
    }
  }
  sums = PointSums(space, groups);
}

/// Moves the area elasticity of material m to a new material, whose groups of elements have another Gauss rule (3.13).
void Part::split_material(const spline::Space& space, const Materials& of_surface, std::size_t m) {
  const Material& material = of_surface.all[m];
  const auto parts = split(material.law);
  if (!parts) return;
  materials[m].law = parts->shear;
  sampled[m] = false;
  std::vector<int> of_this;
  const std::vector<int>& of_element = of_surface.of_element;
  std::ranges::copy_if(elements, std::back_inserter(of_this), [&](int e) { return of_element.empty() || of_element[e] == static_cast<int>(m); });
  for (Group& group : pack(space, of_this, material.area_order)) {
    group.material = static_cast<int>(materials.size());
    groups.push_back(std::move(group));
  }
  materials.push_back({parts->area, {}});
  whole.push_back(material.law);
  sampled.push_back(true);
}

Membrane::Membrane(const spline::Space& space, const Net& unstressed, const Materials& materials, int order)
    : space_(&space), unstressed_(unstressed), materials_(materials), order_(order), all_(indices(space.elements.size())) {
  assert(unstressed.rows() == space.n_points && order >= 2 && order <= 10);
}

std::shared_ptr<const Part> Membrane::part(std::span<const int> elements) const {
  const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const auto& p) { return std::ranges::equal(p->elements, elements); });
  if (found != parts_.end()) return *found;
  if (parts_.size() == parts_kept) parts_.erase(parts_.begin());
  return parts_.emplace_back(std::make_shared<const Part>(*space_, unstressed_, elements, order_, materials_));
}

std::vector<double> Membrane::element_energies(const Net& x, std::span<const int> elements) const {
  std::vector<double> sum(space_->elements.size(), 0.);
  part(elements)->each_batch([&](const Part::Points& at) {
    Pack a[15 * max_gauss], stretching, bending{};
    tangents(at.group, at.batch, x, a);
    membrane::energy(at.material.law, at.n, at.reference, a, &stretching);
    if (at.c0) {
      jets(at.group, at.batch, x, a);
      bending_energy(at.material.bending.modulus, at.n, at.group.weight.data(), at.c0, a, &bending);
    }
    for (int l = 0; l < at.batch.used; ++l) sum[at.batch.elements[l]] += stretching.lanes[l] + bending.lanes[l];
  });
  return sum;
}

void Membrane::load(const Net& x, std::span<const int> elements, Net& d) const {
  d.setZero(space_->n_points, 3);
  const auto mine = part(elements);
  mine->add_rows(d, [&](const Part::Points& at, double* rows) {
    Pack a[6 * max_gauss], p[6 * max_gauss];
    tangents(at.group, at.batch, x, a);
    stresses(at.material.law, at.n, at.reference, a, p);
    transpose(at.group, at.batch, p, rows);
    return true;
  });
  if (!mine->bends()) return;
  mine->add_rows(d, [&](const Part::Points& at, double* rows) {
    if (!at.c0) return false;
    Pack j[15 * max_gauss], p[15 * max_gauss];
    jets(at.group, at.batch, x, j);
    bending_stresses(at.material.bending.modulus, at.n, at.group.weight.data(), at.c0, j, p);
    jet_transpose(at.group, at.batch, p, rows);
    return true;
  });
}

Net Membrane::load(const Net& x) const {
  Net d;
  load(x, all_, d);
  return d;
}

ElementTensions Membrane::element_tensions(const Net& x, std::span<const int> elements, double uniform) const {
  const std::vector<double> none(space_->elements.size(), 0.);
  ElementTensions result{std::numeric_limits<double>::infinity(), 0, none, none, none, none};
  const int lanes = pack_lanes();
  const auto mine = part(elements);
  std::vector<double> smallest(none.size(), result.smallest), largest_change(none.size(), 0);  // of each element
  mine->each_batch([&](const Part::Points& at) {
    const bool sampled = mine->sampled[at.group.material], all_points = at.group.material < static_cast<int>(materials_.all.size());
    Pack a[6 * max_gauss], tension[max_gauss], share[max_gauss];
    const double unit = modulus(at.whole);
    tangents(at.group, at.batch, x, a);
    smaller_tensions(at.whole, at.n, at.reference, a, tension, share);
    for (int q = 0; q < at.n; ++q)
      for (int l = 0; l < at.batch.used; ++l) {
        const double here = numbers(tension)[lanes * q + l] / unit + uniform, area = numbers(share)[lanes * q + l];
        const double unstressed = numbers(at.reference, q, 4)[l], change = area / unstressed - 1;
        const int e = at.batch.elements[l];
        largest_change[e] = std::max(largest_change[e], std::abs(change));
        if (all_points) result.unstressed[e] += unstressed, result.squared_change[e] += unstressed * change * change;
        if (!sampled) continue;
        smallest[e] = std::min(smallest[e], here);
        result.area[e] += area;
        if (here < compressed_below) result.compressed[e] += area;
      }
  });
  result.smallest = std::ranges::min(smallest), result.area_change = std::ranges::max(largest_change);
  return result;
}

Eigen::MatrixX2d tensions(const Law& law, std::span<const surface::Jet> unstressed, std::span<const surface::Jet> now) {
  const auto metric = [](const surface::Jet& a) { return SurfaceMetric<double>{a.s.dot(a.s), a.s.dot(a.t), a.t.dot(a.t)}; };
  Eigen::MatrixX2d result(now.size(), 2);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto [larger, smaller] = squared_stretches(metric(unstressed[i]), metric(now[i]));
    const auto [one, other] = principal_tensions(law, std::sqrt(larger), std::sqrt(smaller));
    result.row(i) << std::min(one, other) / modulus(law), std::max(one, other) / modulus(law);
  }
  return result;
}

/// Stresses in the surface that are linear in a displacement or a velocity u, at the Gauss points of a set of elements.
struct LinearLoad::Points {
  std::shared_ptr<const Part> part;
  std::vector<std::vector<TangentPoint>> of_group;  // one list per group of elements; empty if the group has no such stresses
  // per group: derivatives of x up to the second order at the Gauss points; empty without bending moments that depend on u
  std::vector<std::vector<Pack>> jets;
};

LinearLoad::LinearLoad(const Membrane& membrane) : membrane_(&membrane), points_(std::make_unique<Points>()) {}
LinearLoad::~LinearLoad() = default;
LinearLoad::LinearLoad(LinearLoad&&) noexcept = default;

void LinearLoad::apply(const Net& u, Net& hu) const {
  hu.setZero(membrane_->space().n_points, 3);
  points_->part->add_rows(hu, [&](const Part::Points& at, double* rows) {
    if (points_->of_group[at.g].empty()) return false;
    Pack gradient[6 * max_gauss], p[6 * max_gauss];
    tangents(at.group, at.batch, u, gradient);
    membrane::apply(at.n, &points_->of_group[at.g][at.first], gradient, p);
    transpose(at.group, at.batch, p, rows);
    return true;
  });
  if (points_->jets.empty() || !points_->part->bends()) return;
  points_->part->add_rows(hu, [&](const Part::Points& at, double* rows) {
    if (!at.c0) return false;
    Pack gradient[15 * max_gauss], p[15 * max_gauss];
    jets(at.group, at.batch, u, gradient);
    const Pack* now = &points_->jets[at.g][15 * at.first];
    bending_apply(at.material.bending.modulus, at.n, at.group.weight.data(), at.c0, now, gradient, p);
    jet_transpose(at.group, at.batch, p, rows);
    return true;
  });
}

void Tangent::update(const Net& x, std::span<const int> elements) {
  points_->part = membrane_->part(elements);
  const Part& part = *points_->part;
  points_->of_group.resize(part.groups.size());
  points_->jets.resize(part.groups.size());
  for (std::size_t g = 0; g < part.groups.size(); ++g) {
    points_->of_group[g].resize(part.reference[g].size());
    points_->jets[g].resize(15 * part.relaxed_curvature[g].size());
  }
  part.each_batch([&](const Part::Points& at) {
    Pack a[6 * max_gauss];
    tangents(at.group, at.batch, x, a);
    tangent_points(at.material.law, at.n, at.reference, a, &points_->of_group[at.g][at.first]);
  });
  part.each_bending_batch([&](const Part::Points& at) { jets(at.group, at.batch, x, &points_->jets[at.g][15 * at.first]); });
}

void ViscousLoad::update(const Net& x, std::span<const int> elements) {
  points_->part = membrane_->part(elements);
  const Part& part = *points_->part;
  points_->of_group.resize(part.groups.size());
  for (std::size_t g = 0; g < part.groups.size(); ++g)
    points_->of_group[g].resize(part.materials[part.groups[g].material].viscosity.any() ? part.reference[g].size() : 0);
  part.each_batch([&](const Part::Points& at) {
    if (points_->of_group[at.g].empty()) return;
    Pack a[6 * max_gauss];
    tangents(at.group, at.batch, x, a);
    viscous_points(at.material.viscosity, at.n, at.reference, a, &points_->of_group[at.g][at.first]);
  });
}

Net unstressed(const Net& rest, const Vec3& centre, double alpha) {
  return ((rest.rowwise() - centre.transpose()) / (1 + alpha)).rowwise() + centre.transpose();
}

}  // namespace tanktread::membrane
