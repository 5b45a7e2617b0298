#include "membrane/maxwell_element.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/indices.hpp"

namespace tanktread::membrane {

namespace {

/// Metric of a surface at a Gauss point: contravariant components g^11, g^12, g^22, 1/|g| with |g| = det g_ab, and the area that the point represents
/// (weight times sqrt|g|).
struct Metric {
  Eigen::Vector3d raised;
  double inverse_det, area;
};

}  // namespace

/// Calls use(group, batch, first, a) for every batch. first: index of the first Gauss point of the batch in relaxed_, the array of stress-free
/// metrics. a: tangents of the shape x at the Gauss points of the batch.
template <class Use>
void MaxwellElement::each_batch(const Net& x, const Use& use) const {
  std::size_t first = 0;
  for (const Group& group : groups_)
    for (const Batch& batch : group.batches) {
      Pack a[6 * max_gauss];
      tangents(group, batch, x, a);
      use(group, batch, first, a);
      first += static_cast<std::size_t>(group.n_gauss());
    }
}

/// Calls use(first, q, lane, row, metric of x) for each Gauss point q of the element in each SIMD lane. first: index in relaxed_ of the first Gauss
/// point of the batch. row: index of the Gauss point among all Gauss points of the surface. The area in the metric is zero in lanes without an
/// element.
template <class Use>
void MaxwellElement::each_point(const Net& x, const Use& use) const {
  each_batch(x, [&](const Group& group, const Batch& batch, std::size_t first, const Pack* a) {
    const int n = group.n_gauss(), lanes = pack_lanes();
    ReferencePoint present[max_gauss];
    reference_points(n, batch.used, a, group.weight.data(), present);
    for (int q = 0; q < n; ++q)
      for (int l = 0; l < lanes; ++l) {
        const int element = batch.elements[static_cast<std::size_t>(std::min(l, batch.used - 1))];
        const auto field = [&](int k) { return numbers(present, q, k)[l]; };
        use(first, q, l, first_[static_cast<std::size_t>(element)] + q, Metric{{field(0), field(1), field(2)}, field(3), field(4)});
      }
  });
}

MaxwellElement::MaxwellElement(const spline::Space& space, const Net& initial, int order, const SurfaceViscosity& viscosity, double time)
    : space_(space), spring_{viscosity.shear / time, viscosity.dilatational / time}, time_(time) {
  groups_ = pack(space, indices(space.elements.size()), order);
  first_.resize(space.elements.size());
  Eigen::Index points = 0;
  for (const Group& group : groups_) {
    relaxed_.resize(relaxed_.size() + group.batches.size() * static_cast<std::size_t>(group.n_gauss()));
    for (const Batch& batch : group.batches)
      for (int l = 0; l < batch.used; ++l) first_[static_cast<std::size_t>(batch.elements[l])] = group.n_gauss();
  }
  for (Eigen::Index& first : first_) points += std::exchange(first, points);
  unit_.resize(points, 3);
  each_point(initial, [&](std::size_t, int, int, Eigen::Index row, const Metric& g) {
    unit_.row(row) << g.raised[0], std::sqrt(g.raised[0] * g.raised[2]), g.raised[2];
  });
}

/// Returns g^11, g^12, g^22 of the surface x at each Gauss point.
Eigen::MatrixX3d MaxwellElement::raised_metric(const Net& x) const {
  Eigen::MatrixX3d all(unit_.rows(), 3);
  each_point(x, [&](std::size_t, int, int, Eigen::Index row, const Metric& g) { all.row(row) = g.raised; });
  return all;
}

Eigen::VectorXd MaxwellElement::start(const Net& shape) const {
  const Eigen::MatrixX3d raised = raised_metric(shape);
  Eigen::VectorXd q(size());
  for (Eigen::Index row = 0; row < raised.rows(); ++row) q.segment<3>(3 * row) = raised.row(row).cwiseQuotient(unit_.row(row));
  return q;
}

void MaxwellElement::set_state(const Net& x, const Eigen::VectorXd& q) {
  x_ = x, q_ = q;
  rate_.resize(size());
  dissipation_ = 0;
  each_point(x, [&](std::size_t first, int point, int l, Eigen::Index row, const Metric& g) {
    const Eigen::Vector3d unit = unit_.row(row), c = q.segment<3>(3 * row).cwiseProduct(unit);
    const double det = c[0] * c[2] - c[1] * c[1], j = std::sqrt(det / g.inverse_det);
    const double t = (c[0] * g.raised[2] - 2 * c[1] * g.raised[1] + c[2] * g.raised[0]) / g.inverse_det;
    const double reference[] = {c[0], c[1], c[2], det, g.area / j};
    for (int field = 0; field < 5; ++field) numbers(&relaxed_[first], point, field)[l] = reference[field];
    rate_.segment<3>(3 * row) = (2 * j * j / t * g.raised - (2 - 1 / j) * c).cwiseQuotient(time_ * unit);
    const double shear = spring_.shear_modulus * (t * t - 4 * j * j) / (2 * t * j), area = spring_.dilatation_modulus * (j - 1) * (j - 1);
    dissipation_ += g.area * (shear + area) / time_;
  });
}

Net MaxwellElement::load() const {
  Net d = Net::Zero(space_.n_points, 3);
  each_batch(x_, [&](const Group& group, const Batch& batch, std::size_t first, const Pack* a) {
    Pack p[6 * max_gauss];
    stresses(spring_, group.n_gauss(), &relaxed_[first], a, p);
    add_transpose(group, batch, p, d);
  });
  return d;
}

double MaxwellElement::energy() const {
  double sum = 0;
  each_batch(x_, [&](const Group& group, const Batch& batch, std::size_t first, const Pack* a) {
    Pack stored;
    membrane::energy(spring_, group.n_gauss(), &relaxed_[first], a, &stored);
    for (int l = 0; l < batch.used; ++l) sum += stored.lanes[l];
  });
  return sum;
}

}  // namespace tanktread::membrane
