#include "coupling/wall.hpp"

#include <algorithm>

#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

namespace {

constexpr double mean_of_wave = 0.516;  // harmonics k^-5, as of the single layer of what interpolation by cubic splines leaves

/// The wall's own matrix is made once, so it can be sharper than what changes with the particle.
quadrature::Options sharper(quadrature::Options options) {
  options.tolerance = std::max(1e-12, std::min(1e-7, options.tolerance / 10));
  return options;
}

Net collocation_points(const spline::Space& space, const Net& net) {
  Net at(space.n_points, 3);
  for (int i = 0; i < space.n_points; ++i)
    at.row(i) = surface::value(space, net, space.collocation[static_cast<std::size_t>(i)].front()).transpose();
  return at;
}

Eigen::Map<const Eigen::VectorXd> flat(const Net& net) { return {net.data(), net.size()}; }

/// The whole matrix on every rank, from the rows of each: a few columns of blocks at a time, as a net with a row for each row of a block.
Eigen::MatrixXd everybodys(const stokes::Rows<double>& rows, const std::vector<int>& own, int n, Phases* phases) {
  constexpr int at_a_time = 16;
  Ranks ranks;
  if (phases) ranks.measure(*phases);
  std::vector<int> places;
  for (const int i : own)
    for (int r = 0; r < 3 * at_a_time; ++r) places.push_back(3 * at_a_time * i + r);
  ranks.own(places, 3 * at_a_time * n);
  Eigen::MatrixXd all(3 * n, 3 * n);
  Net part(3 * at_a_time * n, 3);
  for (int first = 0; first < n; first += at_a_time) {
    const int count = std::min(at_a_time, n - first);
    for (std::size_t k = 0; k < own.size(); ++k)
      for (int c = 0; c < 3; ++c)
        for (int j = 0; j < count; ++j)
          part.row(at_a_time * (3 * own[k] + c) + j) = rows.block<1, 3>(3 * static_cast<Eigen::Index>(k) + c, 3 * (first + j));
    ranks.replicate(part);
    for (int i = 0; i < 3 * n; ++i)
      for (int j = 0; j < count; ++j) all.block<1, 3>(i, 3 * (first + j)) = part.row(at_a_time * i + j);
  }
  return all;
}

}  // namespace

Wall::Wall(const surface::TubeWall& wall, const quadrature::Options& quadrature, Phases* phases,
           const surface::Symmetry& symmetry)
    : surface_(wall),
      symmetry_(symmetry.order() > 1 ? symmetry : surface::Symmetry(wall.space.n_points)),
      layer_(stokes::Layer::Kernel::single_layer, surface_.space, {}, quadrature),
      inlet_(wall.outline, wall.start, sharper(quadrature).tolerance),
      sites_(collocation_points(wall.space, wall.net)) {
  const int n = wall.space.n_points, n_rows = static_cast<int>(symmetry_.fundamental().size());
  for (int i = n_rows * ranks_.rank() / ranks_.size(); i < n_rows * (ranks_.rank() + 1) / ranks_.size(); ++i)
    own_.push_back(symmetry_.fundamental()[static_cast<std::size_t>(i)]);
  if (symmetry_.order() > 1)
    ranks_.own(own_, symmetry_);
  else
    ranks_.own(own_, n);
  if (phases) ranks_.measure(*phases);
  layer_.place(wall.net);
  targets_ = sites_, own_targets_ = own_;
  if (wall.channel) {
    boxes_.emplace(patches_.emplace(surface::BezierMap(wall.space), wall.net));
    add_middles();
  }
  assemble(sharper(quadrature));
  factors_ = DenseFactors(symmetry_.order() > 1 ? folded() : everybodys(rows_, own_, n, phases));
  inlet_column_ = collocated(inlet_.integral(targets_));
  pumped_ = solve(inlet_column_);
}

/// To the targets.
void Wall::add_middles() {
  const spline::Space& space = surface_.space;
  const auto n = static_cast<int>(space.elements.size());
  targets_.conservativeResize(space.n_points + n, 3);
  for (int e = 0; e < n; ++e) targets_.row(space.n_points + e) = surface::value(space, surface_.net, {e, 0.5, 0.5}).transpose();
  std::vector<bool> needed(static_cast<std::size_t>(n));
  for (const int i : own_)
    for (const spline::Site& site : space.collocation[static_cast<std::size_t>(i)]) needed[static_cast<std::size_t>(site.element)] = true;
  for (int e = 0; e < n; ++e)
    if (needed[static_cast<std::size_t>(e)]) own_targets_.push_back(space.n_points + e);
}

/// Of the middle of each element around a collocation point, in the mean around that: what is left of a velocity is nearly a wave, which vanishes at
/// these points and whose mean is `mean_of_wave` times what it is in the middles.
double Wall::share_of_middle(int point) const {
  return mean_of_wave / static_cast<double>(surface_.space.collocation[static_cast<std::size_t>(point)].size());
}

/// Rows of this rank, many at a time, for those that are neighbours take the same middles.
void Wall::assemble(const quadrature::Options& quadrature) {
  constexpr std::size_t at_a_time = 240;
  const spline::Space& space = surface_.space;
  stokes::Sites sites = space.collocation;
  if (has_middles())
    for (std::size_t e = 0; e < space.elements.size(); ++e) sites.push_back({{static_cast<int>(e), 0.5, 0.5}});
  stokes::Layer layer(stokes::Layer::Kernel::single_layer, space, sites, quadrature);
  layer.place(surface_.net);
  rows_.resize(3 * static_cast<Eigen::Index>(own_.size()), 3 * space.n_points);
  stokes::Rows<double> part;
  for (std::size_t first = 0; first < own_.size(); first += at_a_time) {
    const auto some = std::span(own_).subspan(first, std::min(at_a_time, own_.size() - first));
    collocate<double>(some, [&](std::span<const int> targets, stokes::Rows<double>& rows) { layer.assemble(targets, rows); }, part);
    rows_.middleRows(3 * static_cast<Eigen::Index>(first), part.rows()) = part;
  }
  assembly_ = layer.evaluations();
}

template <class Real>
void Wall::collocate(std::span<const int> sites, const std::function<void(std::span<const int>, stokes::Rows<Real>&)>& assemble,
                     stokes::Rows<Real>& rows) const {
  if (!has_middles()) return assemble(sites, rows);
  const spline::Space& space = surface_.space;
  std::vector<int> targets(sites.begin(), sites.end()), row(space.elements.size(), -1);  // of middles, among the targets
  for (const int i : sites)
    for (const spline::Site& site : space.collocation[static_cast<std::size_t>(i)])
      if (int& own = row[static_cast<std::size_t>(site.element)]; own < 0) {
        own = static_cast<int>(targets.size());
        targets.push_back(space.n_points + site.element);
      }
  stokes::Rows<Real> all;
  assemble(targets, all);
  rows = static_cast<Real>(1 - mean_of_wave) * all.topRows(3 * static_cast<Eigen::Index>(sites.size()));
  for (std::size_t k = 0; k < sites.size(); ++k)
    for (const spline::Site& site : space.collocation[static_cast<std::size_t>(sites[k])])
      rows.template middleRows<3>(3 * static_cast<Eigen::Index>(k)) +=
          static_cast<Real>(share_of_middle(sites[k])) * all.template middleRows<3>(3 * row[static_cast<std::size_t>(site.element)]);
}
template void Wall::collocate(std::span<const int>, const std::function<void(std::span<const int>, stokes::Rows<float>&)>&,
                              stokes::Rows<float>&) const;

Net Wall::collocated(const Net& u) const {
  Net all = u.topRows(sites_.rows());
  if (has_middles())
    for (const int i : own_) {
      all.row(i) *= 1 - mean_of_wave;
      for (const spline::Site& site : surface_.space.collocation[static_cast<std::size_t>(i)])
        all.row(i) += share_of_middle(i) * u.row(surface_.space.n_points + site.element);
    }
  ranks_.replicate(all);
  return all;
}

/// The matrix between the components of fundamental points that are not zero by the symmetry (4.12).
Eigen::MatrixXd Wall::folded() const {
  const Net& signs = symmetry_.signs();
  const std::vector<int>& source = symmetry_.source();
  Eigen::VectorXi of_component = Eigen::VectorXi::Constant(3 * signs.rows(), -1);
  int n = 0;
  for (const int a : symmetry_.fundamental())
    for (int c = 0; c < 3; ++c)
      if (signs(a, c) != 0) of_component[3 * a + c] = n++;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < own_.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      const int row = of_component[3 * own_[k] + c];
      if (row < 0) continue;
      const auto entries = rows_.row(3 * static_cast<Eigen::Index>(k) + c);
      for (Eigen::Index p = 0; p < signs.rows(); ++p)
        for (int d = 0; d < 3; ++d)
          if (signs(p, d) != 0) all(row, of_component[3 * source[static_cast<std::size_t>(p)] + d]) += signs(p, d) * entries[3 * p + d];
    }
  ranks_.add({all.data(), static_cast<std::size_t>(all.size())});
  return all;
}

Net Wall::apply(const Net& f) const {
  Net u(f.rows(), 3);
  for (std::size_t k = 0; k < own_.size(); ++k)
    for (int i = 0; i < 3; ++i) u(own_[k], i) = rows_.row(3 * static_cast<Eigen::Index>(k) + i).dot(flat(f));
  ranks_.replicate(u);
  return u;
}

Net Wall::solve(const Net& rhs) const {
  if (symmetry_.order() > 1) {
    Net f = fundamental_net(factors_.solve(fundamental(rhs)));
    symmetry_.complete(f);
    return f;
  }
  const Eigen::VectorXd f = factors_.solve(flat(rhs));
  return Eigen::Map<const Net>(f.data(), rhs.rows(), 3);
}

Net Wall::solve_transposed(const Net& weights) const {
  if (symmetry_.order() > 1) {
    Net folded = weights;
    for (Eigen::Index p = 0; p < weights.rows(); ++p) {
      const int a = symmetry_.source()[static_cast<std::size_t>(p)];
      if (a != p) folded.row(a) += symmetry_.signs().row(p).cwiseProduct(weights.row(p));
    }
    return fundamental_net(factors_.solve_transposed(fundamental(folded)));
  }
  const Eigen::VectorXd a = factors_.solve_transposed(flat(weights));
  return Eigen::Map<const Net>(a.data(), weights.rows(), 3);
}

/// Components of fundamental points that are not zero by the symmetry, one after the other.
Eigen::VectorXd Wall::fundamental(const Net& net) const {
  std::vector<double> numbers;
  for (const int a : symmetry_.fundamental())
    for (int c = 0; c < 3; ++c)
      if (symmetry_.signs()(a, c) != 0) numbers.push_back(net(a, c));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

/// The same back, images zero.
Net Wall::fundamental_net(const Eigen::VectorXd& numbers) const {
  Net net = Net::Zero(sites_.rows(), 3);
  Eigen::Index n = 0;
  for (const int a : symmetry_.fundamental())
    for (int c = 0; c < 3; ++c)
      if (symmetry_.signs()(a, c) != 0) net(a, c) = numbers[n++];
  return net;
}

/// Along the wall with the points crowded towards the ends of each element, where the inlet's integral is steep at the rim: s = 3 q^2 - 2 q^3.
Net Wall::weights(const std::function<Vec3(const Vec3&)>& field) const {
  constexpr int along = 16, around = 6;
  const quadrature::GaussRule &in_s = quadrature::gauss(along), &in_t = quadrature::gauss(around);
  const spline::Space& space = surface_.space;
  Net sum = Net::Zero(space.n_points, 3);
  for (std::size_t e = 0; e < space.elements.size(); ++e)
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < around; ++j) {
        const double q = in_s.nodes[i];
        const spline::Site site{static_cast<int>(e), q * q * (3 - 2 * q), in_t.nodes[j]};
        const surface::Point at = surface::point(space, surface_.net, site);
        const Vec3 value = in_s.weights[i] * 6 * q * (1 - q) * in_t.weights[j] * at.jacobian * field(at.x);
        const Eigen::VectorXd basis = spline::basis(space.elements[e], site.s, site.t, 0).value;
        for (std::size_t a = 0; a < space.elements[e].points.size(); ++a)
          sum.row(space.elements[e].points[a]) += basis[static_cast<Eigen::Index>(a)] * value.transpose();
      }
  return sum;
}

Net Wall::flow_weights() const {
  return weights([&](const Vec3& x) -> Vec3 { return inlet_.integral(Net(x.transpose())).row(0).transpose(); });
}

Net Wall::force_weights() const {
  return weights([](const Vec3&) -> Vec3 { return Vec3::UnitX(); });
}

stokes::Evaluations Wall::evaluations() const {
  return assembly_ + layer_.evaluations();
}

}  // namespace tanktread::coupling
