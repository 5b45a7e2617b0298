#include "system/solids/film_inverses.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tanktread::coupling {

namespace {

/// A film ends where it is this wide, over the smaller radius: from there on waves as long as that are damped across it by a third and more.
constexpr double widest = 0.5;

/// A body, its sites, and a ball about their mean that holds them.
struct Side {
  std::size_t particle;
  spline::Block block;
  double radius;
  Net sites;
  Eigen::RowVector3d middle;
  double extent;

  Side(std::size_t p, const Particle& of, const Net& all_sites)
      : particle(p), block(of.block), radius(of.radius), sites(block.rows(all_sites)), middle(sites.colwise().mean()),
        extent((sites.rowwise() - middle).rowwise().norm().maxCoeff()) {}

  /// Its sites that are closer than `reach` to one of the other's, from 0 on.
  std::vector<int> close_to(const Side& other, double reach) const {
    std::vector<int> close;
    for (int i = 0; i < block.n_points; ++i)
      if ((other.sites.rowwise() - sites.row(i)).rowwise().squaredNorm().minCoeff() < reach * reach) close.push_back(i);
    return close;
  }
};

/// C of what `by` does to sites of another body: -H M^-1, from the other's rows of H and the sites of `by`.
Eigen::MatrixXd coupling(const stokes::Rows<double>& rows, const Side& by, std::span<const int> sites, const OneBodyInverses& alone,
                         const RigidParticles& placed) {
  return -rows.middleCols(3 * by.block.first_point, 3 * by.block.n_points) * alone.columns(placed, by.particle, sites);
}

}  // namespace

FilmInverses::FilmInverses(std::span<const Particle> particles, const OneBodyInverses& alone, const RigidParticles& placed, const Net& x,
                           const RowsOf& rows_of) {
  if (alone.empty()) return;
  Net sites = x;
  alone.take_to_sites(sites);
  std::vector<Side> sides;
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (alone.serves(p)) sides.emplace_back(p, particles[p], sites);
  for (auto one = sides.begin(); one != sides.end(); ++one)
    for (auto other = one + 1; other != sides.end(); ++other) {
      const double reach = widest * std::min(one->radius, other->radius);
      if ((one->middle - other->middle).norm() > one->extent + other->extent + reach) continue;
      const std::vector<int> here = one->close_to(*other, reach), there = other->close_to(*one, reach);
      if (here.empty()) continue;
      Film film;
      for (const int i : here) film.sites.push_back(one->block.first_point + i);
      for (const int i : there) film.sites.push_back(other->block.first_point + i);
      const stokes::Rows<double> rows = rows_of(film.sites);
      const auto n = static_cast<Eigen::Index>(3 * here.size()), m = static_cast<Eigen::Index>(3 * there.size());
      Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n + m, n + m);
      all.topRightCorner(n, m) = coupling(rows.topRows(n), *other, there, alone, placed);
      all.bottomLeftCorner(m, n) = coupling(rows.bottomRows(m), *one, here, alone, placed);
      film.one_and_coupling = DenseFactors(std::move(all));
      films_.push_back(std::move(film));
    }
}

void FilmInverses::add(Net& y) const {
  const Net before = y;
  for (const Film& film : films_) {
    Eigen::VectorXd right(3 * static_cast<Eigen::Index>(film.sites.size()));
    for (std::size_t k = 0; k < film.sites.size(); ++k) right.segment<3>(3 * static_cast<Eigen::Index>(k)) = before.row(film.sites[k]).transpose();
    const Eigen::VectorXd change = film.one_and_coupling.solve(right) - right;
    for (std::size_t k = 0; k < film.sites.size(); ++k) y.row(film.sites[k]) += change.segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
  }
}

}  // namespace tanktread::coupling
