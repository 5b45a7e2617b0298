#include "system/solids/bodies/body_preconditioner.hpp"

#include <algorithm>
#include <utility>

#include "base/dense_factors.hpp"
#include "base/indices.hpp"
#include "stokes/layer.hpp"
#include "system/parallel/stop_together.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

OneBodyInverses::OneBodyInverses(std::span<const Particle> particles, const RigidParticles& bodies, const Net& rest,
                                 const quadrature::Options& quadrature) {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Particle& particle = particles[p];
    if (!particle.rigid || particle.block.n_points > most_points) continue;
    const auto alike = std::ranges::find_if(factors_, [&](const Use& use) {
      return use.factors->prescribed == particle.rigid->prescribed && bodies.double_layer(use.particle).alike(bodies.double_layer(p));
    });
    factors_.push_back(
        {p, particle.block, alike == factors_.end() ? inverted(particle, bodies, p, particle.block.rows(rest), quadrature) : alike->factors});
  }
}

/// Returns the inverse of the operator w -> R <w> - D w of (2.23) for one body. R is the collocation matrix, <w> the rigid motion nearest to w, and D
/// the double layer times the viscosity contrast -1. If the motion of the body is prescribed, (1/mu) A f replaces R <w>. Here A is the single layer,
/// f = (mu/R_C) <w>, and R_C the particle radius.
std::shared_ptr<const OneBodyInverses::Factors> OneBodyInverses::inverted(const Particle& particle, const RigidParticles& bodies, std::size_t p,
                                                                          const Net& own, const quadrature::Options& quadrature) {
  auto factors = std::make_shared<Factors>();
  factors->prescribed = particle.rigid->prescribed;
  factors->sites = collocation_matrix(*particle.space);
  const std::vector<int> all = indices(particle.space->n_points);
  stokes::Rows<double> matrix;
  const spline::Space& space = *particle.space;
  stokes::Layer double_layer(stokes::Layer::Kernel::double_layer, space, space.collocation, quadrature);
  double_layer.set_shape(own);
  stop_together([&] { double_layer.assemble(all, matrix); });  // the double layer without the viscosity contrast, -D
  stokes::Layer layer(stokes::Layer::Kernel::single_layer, space, space.collocation, quadrature);
  layer.set_shape(own);
  const Vec3 centre = bodies.rest_centre(p);
  const BodyDensity& body = bodies.double_layer(p);
  for (int k = 0; k < 6; ++k) {
    Net field = rigid_velocity(own, unit_motion(k), centre), at_sites = factors->sites * field;
    if (factors->prescribed) {
      layer.apply(field / particle.radius, all, at_sites);
      at_sites += factors->sites * body.of_load(unit_motion(k)) / particle.radius;
    }
    matrix += flat(at_sites) * body.mean_functional(k).transpose();
  }
  stop_together([&] { factors->inverse = DenseFactors(matrix).inverse(); });
  return factors;
}

const OneBodyInverses::Use* OneBodyInverses::of_particle(std::size_t p) const {
  const auto use = std::ranges::find(factors_, p, &Use::particle);
  return use == factors_.end() ? nullptr : &*use;
}

void OneBodyInverses::evaluate_at_sites(Net& y) const {
  for (const auto& [particle, block, factors] : factors_) block.rows(y) = factors->sites * Net(block.rows(y));
}

void OneBodyInverses::solve(const RigidParticles& placed, Net& y) const {
  for (const auto& [particle, block, factors] : factors_) {
    const Mat3 turn = placed.turn(particle);
    const Net right = block.rows(y) * turn;
    const Eigen::VectorXd solution = factors->inverse * flat(right);
    block.rows(y) = as_net(solution) * turn.transpose();
  }
}

Eigen::MatrixXd OneBodyInverses::columns(const RigidParticles& placed, std::size_t p, std::span<const int> sites) const {
  const Eigen::MatrixXd& inverse = of_particle(p)->factors->inverse;
  const Mat3 turn = placed.turn(p);
  Eigen::MatrixXd columns(inverse.rows(), 3 * static_cast<Eigen::Index>(sites.size()));
  for (std::size_t k = 0; k < sites.size(); ++k)
    columns.middleCols<3>(3 * static_cast<Eigen::Index>(k)) = inverse.middleCols<3>(3 * sites[k]) * turn.transpose();
  for (Eigen::Index a = 0; a < columns.rows(); a += 3) columns.middleRows<3>(a) = (turn * columns.middleRows<3>(a)).eval();
  return columns;
}

namespace {

/// Largest thickness h of a film for which FilmInverses computes an inverse, divided by the smaller radius R of the two bodies. Thicker films need no
/// inverse, because their eigenvalues are not small: they are of the order of k h, with wave numbers k of at least about 1/R.
constexpr double widest = 0.5;

/// A body with its collocation sites, and the ball (centre `middle`, radius `extent`) that contains all sites.
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

  /// Returns the indices (from 0) of the sites that are closer than `reach` to a site of the other body.
  std::vector<int> close_to(const Side& other, double reach) const {
    std::vector<int> close;
    for (int i = 0; i < block.n_points; ++i)
      if ((other.sites.rowwise() - sites.row(i)).rowwise().squaredNorm().minCoeff() < reach * reach) close.push_back(i);
    return close;
  }
};

/// Returns C = -D M^-1 (see FilmInverses): the effect of the body `by` on the sites of another body. M is the operator of the isolated body `by`.
/// `rows`: rows of the double layer D for the sites of the other body. `sites`: sites of `by`. C has only the columns of these sites.
Eigen::MatrixXd coupling(const stokes::Rows<double>& rows, const Side& by, std::span<const int> sites, const OneBodyInverses& alone,
                         const RigidParticles& placed) {
  return -rows.middleCols(3 * by.block.first_point, 3 * by.block.n_points) * alone.columns(placed, by.particle, sites);
}

}  // namespace

FilmInverses::FilmInverses(std::span<const Particle> particles, const OneBodyInverses& alone, const RigidParticles& placed, const Net& x,
                           const RowsOf& rows_of) {
  if (alone.empty()) return;
  Net sites = x;
  alone.evaluate_at_sites(sites);
  std::vector<Side> sides;
  for (std::size_t p = 0; p < particles.size(); ++p)
    if (alone.has(p)) sides.emplace_back(p, particles[p], sites);
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
    const Net own = before(film.sites, Eigen::all);
    const Eigen::VectorXd right = flat(own), change = film.one_and_coupling.solve(right) - right;
    y(film.sites, Eigen::all) += as_net(change);
  }
}

}  // namespace tanktread::coupling
