#include "system/solids/ducts/wall_points.hpp"

#include <map>

#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"

namespace tanktread::coupling {
namespace {

constexpr double mean_of_wave = 0.516;  // m of (2.39): mean of the velocity error on the wall divided by the error at the midpoints of elements, if
                                        // the harmonics of the error decrease with the wave number k like k^-5 (k^-4 from spline interpolation, k^-1
                                        // from the single layer)

}  // namespace

Net positions(const surface::TubeWall& wall, const stokes::Sites& sites) {
  Net at(static_cast<Eigen::Index>(sites.size()), 3);
  for (Eigen::Index i = 0; i < at.rows(); ++i)
    at.row(i) = surface::value(wall.space, wall.net, sites[static_cast<std::size_t>(i)].front()).transpose();
  return at;
}

Net wall_integrals(const surface::TubeWall& wall, const std::function<Vec3(const surface::Point&)>& field) {
  constexpr int along = 16, around = 6;
  const quadrature::GaussRule &in_s = quadrature::gauss(along), &in_t = quadrature::gauss(around);
  const spline::Space& space = wall.space;
  Net sum = Net::Zero(space.n_points, 3);
  for (std::size_t e = 0; e < space.elements.size(); ++e)
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < around; ++j) {
        const double q = in_s.nodes[i];
        const spline::Site site{static_cast<int>(e), q * q * (3 - 2 * q), in_t.nodes[j]};
        const surface::Point at = surface::point(space, wall.net, site);
        const Vec3 value = in_s.weights[i] * 6 * q * (1 - q) * in_t.weights[j] * at.jacobian * field(at);
        const Eigen::VectorXd basis = spline::basis(space.elements[e], site.s, site.t, 0).value;
        for (std::size_t a = 0; a < space.elements[e].points.size(); ++a)
          sum.row(space.elements[e].points[a]) += basis[static_cast<Eigen::Index>(a)] * value.transpose();
      }
  return sum;
}

WallPoints::WallPoints(const surface::TubeWall& wall, const surface::Symmetry& symmetry, Phases* phases) : sites_(positions(wall, wall.sites)) {
  own_ = ranks_.divide_in_order(symmetry);
  if (phases) ranks_.measure(*phases);
  own_targets_ = own_;
  if (surface::properties(wall.kind).uses_means) {
    // On a periodic wall, site.element is an element of the traction density, not of the geometry.
    const auto first = static_cast<int>(sites_.rows());
    for (const auto& at : wall.sites) {
      middles_.emplace_back();
      for (const spline::Site& site : at) middles_.back().push_back(first + wall.middle_of[static_cast<std::size_t>(site.element)]);
    }
    std::vector<bool> needed(wall.middles.size());
    for (const int i : own_)
      for (const int target : middles_[static_cast<std::size_t>(i)]) needed[static_cast<std::size_t>(target - first)] = true;
    for (std::size_t e = 0; e < needed.size(); ++e)
      if (needed[e]) own_targets_.push_back(first + static_cast<int>(e));
  }
  targets_ = positions(wall, target_sites(wall));
}

stokes::Sites WallPoints::target_sites(const surface::TubeWall& wall) const {
  stokes::Sites sites = wall.sites;
  if (surface::properties(wall.kind).uses_means)
    for (const spline::Site& middle : wall.middles) sites.push_back({middle});
  return sites;
}

/// Returns the weight of each adjacent element midpoint in the mean velocity (2.39) around a collocation point. Between collocation points the
/// residual velocity is nearly a wave, whose mean is `mean_of_wave` times its value at the midpoints.
double WallPoints::share_of_middle(int site) const { return mean_of_wave / static_cast<double>(middles_[static_cast<std::size_t>(site)].size()); }

template <class Real>
void WallPoints::collocate(std::span<const int> sites, const std::function<void(std::span<const int>, stokes::Rows<Real>&)>& assemble,
                           stokes::Rows<Real>& rows) const {
  if (middles_.empty()) return assemble(sites, rows);
  std::vector<int> targets(sites.begin(), sites.end());
  std::map<int, int> row;  // index of each midpoint among `targets`
  for (const int i : sites)
    for (const int middle : middles_[static_cast<std::size_t>(i)])
      if (row.emplace(middle, static_cast<int>(targets.size())).second) targets.push_back(middle);
  stokes::Rows<Real> all;
  assemble(targets, all);
  rows = static_cast<Real>(1 - mean_of_wave) * all.topRows(3 * static_cast<Eigen::Index>(sites.size()));
  for (std::size_t k = 0; k < sites.size(); ++k)
    for (const int middle : middles_[static_cast<std::size_t>(sites[k])])
      rows.template middleRows<3>(3 * static_cast<Eigen::Index>(k)) +=
          static_cast<Real>(share_of_middle(sites[k])) * all.template middleRows<3>(3 * row.at(middle));
}
template void WallPoints::collocate(std::span<const int>, const std::function<void(std::span<const int>, stokes::Rows<float>&)>&,
                                    stokes::Rows<float>&) const;
template void WallPoints::collocate(std::span<const int>, const std::function<void(std::span<const int>, stokes::Rows<double>&)>&,
                                    stokes::Rows<double>&) const;

Net WallPoints::collocated(const Net& u) const {
  return ranks_.filled(sites_.rows(), [&](Net& all) {
    for (const int i : own_) {
      all.row(i) = (middles_.empty() ? 1 : 1 - mean_of_wave) * u.row(i);
      if (middles_.empty()) continue;
      for (const int middle : middles_[static_cast<std::size_t>(i)]) all.row(i) += share_of_middle(i) * u.row(middle);
    }
  });
}

}  // namespace tanktread::coupling
