#include "system/solids/wall.hpp"

#include <algorithm>

#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

namespace {

constexpr double residual = 1e-2;        // that an iteration leaves, over the tolerance of integrals
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

}  // namespace

Wall::Wall(const surface::TubeWall& wall, const quadrature::Options& quadrature, Phases* phases,
           const surface::Symmetry& symmetry, const std::string& solver)
    : surface_(wall),
      symmetry_(symmetry.order() > 1 ? symmetry : surface::Symmetry(wall.space.n_points)),
      layer_(stokes::Layer::Kernel::single_layer, surface_.space, {}, quadrature),
      inlet_(wall.outline, wall.start, sharper(quadrature).tolerance),
      sites_(collocation_points(wall.space, wall.net)),
      tolerance_(residual * quadrature.tolerance) {
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
  if (wall.channel) boxes_.emplace(patches_.emplace(surface::BezierMap(wall.space), wall.net));
  if (has_middles()) add_middles();
  stokes::Sites sites = wall.space.collocation;
  for (int e = 0; e < targets_.rows() - n; ++e) sites.push_back({{e, 0.5, 0.5}});
  on_itself_ = std::make_unique<stokes::Layer>(stokes::Layer::Kernel::single_layer, surface_.space, sites, sharper(quadrature));
  on_itself_->place(wall.net);
  if (iterates(solver, 3.0 * n / symmetry_.order())) {
    patches_of_rows_.emplace(surface_, *on_itself_, symmetry_.fundamental());
    krylov_ = std::make_unique<Krylov>(IterativeOptions{.solver = "GMRES", .preconditioner = "recycled"});
  } else {
    factors_ = DenseFactors(assembled());
  }
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

/// The matrix between the components of fundamental points that are not zero by the symmetry (4.12), on every rank. Rows of this one are made many at
/// a time, for those that are neighbours take the same middles.
Eigen::MatrixXd Wall::assembled() {
  constexpr std::size_t at_a_time = 240;
  const Net& signs = symmetry_.signs();
  Eigen::VectorXi of_component = Eigen::VectorXi::Constant(3 * signs.rows(), -1);
  int n = 0;
  for (const int a : symmetry_.fundamental())
    for (int c = 0; c < 3; ++c)
      if (signs(a, c) != 0) of_component[3 * a + c] = n++;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  stokes::Rows<double> part;
  for (std::size_t first = 0; first < own_.size(); first += at_a_time) {
    const auto some = std::span(own_).subspan(first, std::min(at_a_time, own_.size() - first));
    collocate<double>(some, [&](std::span<const int> targets, stokes::Rows<double>& rows) { on_itself_->assemble(targets, rows); }, part);
    for (Eigen::Index p = 0; p < signs.rows(); ++p)
      for (int d = 0; d < 3; ++d) {
        if (signs(p, d) == 0) continue;
        const int column = of_component[3 * symmetry_.source()[static_cast<std::size_t>(p)] + d];
        for (std::size_t k = 0; k < some.size(); ++k)
          for (int c = 0; c < 3; ++c)
            if (const int row = of_component[3 * some[k] + c]; row >= 0)
              all(row, column) += signs(p, d) * part(3 * static_cast<Eigen::Index>(k) + c, 3 * p + d);
      }
  }
  ranks_.add({all.data(), static_cast<std::size_t>(all.size())});
  return all;
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

Net Wall::apply(const Net& f) const {
  Net u(targets_.rows(), 3);
  on_itself_->apply(f, own_targets_, u);
  return collocated(u);
}

Net Wall::solve(const Net& rhs) const {
  if (iterates()) return iterated(rhs);
  Net f = fundamental_net(factors_.solve(fundamental(rhs)));
  symmetry_.complete(f);
  return f;
}

void Wall::forget_recycled() const {
  if (krylov_) krylov_->forget();
}

Net Wall::iterated(const Net& rhs) const {
  const Eigen::VectorXd b = fundamental(rhs);
  const auto through = [&](const std::function<void(const Net&, Net&)>& map) {
    return [this, map, n = b.size()](const double* in, double* out) {
      Net given = fundamental_net(Eigen::Map<const Eigen::VectorXd>(in, n)), found = given;
      symmetry_.complete(given);
      map(given, found);
      Eigen::Map<Eigen::VectorXd>(out, n) = fundamental(found);
    };
  };
  const LinearSystem system{{{"wall traction", b.size()}},
                            through([this](const Net& f, Net& u) { u = apply(f); }),
                            through([this](const Net& u, Net& f) { patches_of_rows_->apply(u, f); })};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  require_convergence(krylov_->solve(system, b, x, tolerance_), "the wall", tolerance_);
  Net f = fundamental_net(x);
  symmetry_.complete(f);
  return f;
}

Net Wall::solve_transposed(const Net& weights) const {
  Net folded = weights;
  for (Eigen::Index p = 0; p < weights.rows(); ++p) {
    const int a = symmetry_.source()[static_cast<std::size_t>(p)];
    if (a != p) folded.row(a) += symmetry_.signs().row(p).cwiseProduct(weights.row(p));
  }
  return fundamental_net(factors_.solve_transposed(fundamental(folded)));
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
  return on_itself_->evaluations() + layer_.evaluations();
}

}  // namespace tanktread::coupling
