#include "coupling/film_inverses.hpp"

#include <algorithm>
#include <cmath>

namespace tanktread::coupling {

namespace {

/// A film ends where it is this wide, over the smaller radius: from there on waves as long as that are damped across it by a third and more.
constexpr double widest = 0.5;

/// The sites of a body, `of`, that are closer than `reach` to one of the other's, by number among all particles.
std::vector<int> close_sites(const spline::Block& of, const spline::Block& other, const Net& sites, double reach) {
  const Net there = other.rows(sites);
  std::vector<int> close;
  for (int i = of.first_point; i < of.first_point + of.n_points; ++i)
    if ((there.rowwise() - sites.row(i)).rowwise().squaredNorm().minCoeff() < reach * reach) close.push_back(i);
  return close;
}

/// Whether balls about the means of two blocks' sites, that hold them, are closer than `reach`.
bool may_be_close(const Net& a, const Net& b, double reach) {
  const Eigen::RowVector3d a0 = a.colwise().mean(), b0 = b.colwise().mean();
  const auto radius = [](const Net& of, const Eigen::RowVector3d& mean) { return (of.rowwise() - mean).rowwise().norm().maxCoeff(); };
  return (a0 - b0).norm() < radius(a, a0) + radius(b, b0) + reach;
}

}  // namespace

FilmInverses::FilmInverses(std::span<const Particle> particles, const OneBodyInverses& alone, const RigidParticles& placed, const Net& x,
                           const RowsOf& rows_of) {
  if (alone.empty()) return;
  Net sites = x;
  alone.take_to_sites(sites);
  for (std::size_t p = 0; p < particles.size(); ++p)
    for (std::size_t q = p + 1; q < particles.size(); ++q) {
      if (!alone.serves(p) || !alone.serves(q)) continue;
      const spline::Block &one = particles[p].block, &other = particles[q].block;
      const double reach = widest * std::min(particles[p].radius, particles[q].radius);
      if (!may_be_close(one.rows(sites), other.rows(sites), reach)) continue;
      Film film{close_sites(one, other, sites, reach), {}};
      const auto of_one = static_cast<Eigen::Index>(3 * film.sites.size());
      if (of_one == 0) continue;
      std::ranges::copy(close_sites(other, one, sites, reach), std::back_inserter(film.sites));
      const auto of_both = static_cast<Eigen::Index>(3 * film.sites.size()), of_other = of_both - of_one;
      const stokes::Rows<double> rows = rows_of(film.sites);
      const auto own = [&](std::size_t body, const spline::Block& block, std::span<const int> numbers) {
        std::vector<int> local;
        for (const int i : numbers) local.push_back(i - block.first_point);
        return alone.columns(placed, body, local);
      };
      const std::span all(film.sites);
      Eigen::MatrixXd coupling = Eigen::MatrixXd::Identity(of_both, of_both);
      coupling.topRightCorner(of_one, of_other) = -rows.block(0, 3 * other.first_point, of_one, 3 * other.n_points) *
                                                  own(q, other, all.subspan(static_cast<std::size_t>(of_one / 3)));
      coupling.bottomLeftCorner(of_other, of_one) = -rows.block(of_one, 3 * one.first_point, of_other, 3 * one.n_points) *
                                                    own(p, one, all.first(static_cast<std::size_t>(of_one / 3)));
      film.coupling.compute(coupling);
      films_.push_back(std::move(film));
    }
}

void FilmInverses::add(Net& y) const {
  const Net before = y;
  for (const Film& film : films_) {
    Eigen::VectorXd right(3 * static_cast<Eigen::Index>(film.sites.size()));
    for (std::size_t k = 0; k < film.sites.size(); ++k) right.segment<3>(3 * static_cast<Eigen::Index>(k)) = before.row(film.sites[k]).transpose();
    const Eigen::VectorXd change = film.coupling.solve(right) - right;
    for (std::size_t k = 0; k < film.sites.size(); ++k) y.row(film.sites[k]) += change.segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
  }
}

}  // namespace tanktread::coupling
