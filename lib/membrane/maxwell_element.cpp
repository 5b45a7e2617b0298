#include "membrane/maxwell_element.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tanktread::membrane {

namespace {

constexpr int most_points = max_order * max_order;

/// A metric's components with upper indices, and its Jacobian.
struct Contravariant {
  double g11, g12, g22, jacobian;
};

/// Of the surface, in lane l, from its tangents at a Gauss point.
Contravariant raised(const double* a, int lanes, int l) {
  double ss = 0, st = 0, tt = 0;
  for (int c = 0; c < 3; ++c) {
    const double s = a[lanes * c + l], t = a[lanes * (3 + c) + l];
    ss += s * s, st += s * t, tt += t * t;
  }
  const double det = ss * tt - st * st;
  return {tt / det, -st / det, ss / det, std::sqrt(det)};
}

}  // namespace

/// Calls use(batch's reference, point, lane, row of q, Gauss weight, metric of x) for the Gauss points of every lane; the weight of idle ones is 0.
template <class Use>
void MaxwellElement::each_point(const Net& x, const Use& use) {
  const int lanes = pack_lanes();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    const int n = group.n_gauss();
    Pack a[6 * most_points];
    for (std::size_t k = 0; k < group.batches.size(); ++k) {
      const Batch& batch = group.batches[k];
      ReferencePoint* const relaxed = &relaxed_[g][k * static_cast<std::size_t>(n)];
      tangents(group, batch, x, a);
      for (int q = 0; q < n; ++q)
        for (int l = 0; l < lanes; ++l) {
          const int element = batch.elements[static_cast<std::size_t>(std::min(l, batch.used - 1))];
          const double weight = l < batch.used ? group.weight[static_cast<std::size_t>(q)] : 0;
          use(relaxed, q, l, first_[static_cast<std::size_t>(element)] + q, weight, raised(numbers(a) + 6 * lanes * q, lanes, l));
        }
    }
  }
}

MaxwellElement::MaxwellElement(const spline::Space& space, const Net& initial, int order, const SurfaceViscosity& viscosity, double time)
    : space_(space), spring_{viscosity.shear / time, viscosity.dilatational / time}, time_(time) {
  std::vector<int> all(space.elements.size());
  std::iota(all.begin(), all.end(), 0);
  groups_ = pack(space, all, order);
  first_.resize(all.size());
  Eigen::Index points = 0;
  for (const Group& group : groups_) {
    relaxed_.emplace_back(group.batches.size() * static_cast<std::size_t>(group.n_gauss()), ReferencePoint{});
    for (const Batch& batch : group.batches)
      for (int l = 0; l < batch.used; ++l) first_[static_cast<std::size_t>(batch.elements[l])] = group.n_gauss();
  }
  for (Eigen::Index& first : first_) points += std::exchange(first, points);
  unit_.resize(points, 2);
  each_point(initial, [&](ReferencePoint*, int, int, Eigen::Index row, double, const Contravariant& g) {
    unit_.row(row) << std::sqrt(g.g11), std::sqrt(g.g22);
  });
}

Eigen::VectorXd MaxwellElement::start(const Net& shape) {
  Eigen::VectorXd q(size());
  each_point(shape, [&](ReferencePoint*, int, int, Eigen::Index row, double, const Contravariant& g) {
    const double u = unit_(row, 0), v = unit_(row, 1);
    q.segment<3>(3 * row) << g.g11 / (u * u), g.g12 / (u * v), g.g22 / (v * v);
  });
  return q;
}

void MaxwellElement::place(const Net& x, const Eigen::VectorXd& q) {
  x_ = x;
  rate_.resize(size());
  dissipation_ = 0;
  each_point(x, [&](ReferencePoint* relaxed, int point, int l, Eigen::Index row, double weight, const Contravariant& g) {
    const Eigen::Vector3d unit(unit_(row, 0) * unit_(row, 0), unit_(row, 0) * unit_(row, 1), unit_(row, 1) * unit_(row, 1));
    const Eigen::Vector3d c = q.segment<3>(3 * row).cwiseProduct(unit);
    const double det = c[0] * c[2] - c[1] * c[1], present = g.jacobian * g.jacobian;
    const double t = present * (c[0] * g.g22 - 2 * c[1] * g.g12 + c[2] * g.g11), j = g.jacobian * std::sqrt(det);
    const double reference[] = {c[0], c[1], c[2], det, weight / std::sqrt(det)};
    for (int field = 0; field < 5; ++field) numbers(relaxed, point, field)[l] = reference[field];
    rate_.segment<3>(3 * row) = (2 * j * j / t * Eigen::Vector3d(g.g11, g.g12, g.g22) - (2 - 1 / j) * c).cwiseQuotient(time_ * unit);
    const double shear = spring_.shear_modulus * (t * t - 4 * j * j) / (2 * t * j), area = spring_.dilatation_modulus * (j - 1) * (j - 1);
    dissipation_ += weight * g.jacobian * (shear + area) / time_;
  });
}

Net MaxwellElement::load() const {
  Net d = Net::Zero(space_.n_points, 3);
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t k = 0; k < groups_[g].batches.size(); ++k) {
      Pack a[6 * most_points], p[6 * most_points];
      tangents(groups_[g], groups_[g].batches[k], x_, a);
      const int n = groups_[g].n_gauss();
      stresses(spring_, n, &relaxed_[g][k * static_cast<std::size_t>(n)], a, p);
      add_transpose(groups_[g], groups_[g].batches[k], p, d);
    }
  return d;
}

double MaxwellElement::energy() const {
  double sum = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t k = 0; k < groups_[g].batches.size(); ++k) {
      Pack a[6 * most_points], stored;
      tangents(groups_[g], groups_[g].batches[k], x_, a);
      const int n = groups_[g].n_gauss();
      membrane::energy(spring_, n, &relaxed_[g][k * static_cast<std::size_t>(n)], a, &stored);
      for (int l = 0; l < groups_[g].batches[k].used; ++l) sum += stored.room[l];
    }
  return sum;
}

}  // namespace tanktread::membrane
