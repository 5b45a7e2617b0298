#include "system/solids/one_body.hpp"

#include <algorithm>
#include <numeric>

#include "base/dense_factors.hpp"
#include "stokes/layer.hpp"
#include "system/collocation.hpp"

namespace tanktread::coupling {

OneBodyInverses::OneBodyInverses(std::span<const Particle> particles, const RigidParticles& bodies, const Net& rest,
                                 const quadrature::Options& quadrature) {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Particle& particle = particles[p];
    if (!particle.rigid || particle.block.n_points > most_points) continue;
    const auto alike = std::ranges::find_if(
        factors_, [&](const Use& use) { return use.factors->prescribed == particle.rigid->prescribed && bodies.alike(use.particle, p); });
    factors_.push_back(
        {p, particle.block, alike == factors_.end() ? inverted(particle, bodies, p, particle.block.rows(rest), quadrature) : alike->factors});
  }
}

/// R B = R (v -> <v>) - H, or with (1/mu) A (v -> (mu/R_C) <v>).
std::shared_ptr<const OneBodyInverses::Factors> OneBodyInverses::inverted(const Particle& particle, const RigidParticles& bodies, std::size_t p,
                                                                          const Net& own, const quadrature::Options& quadrature) {
  auto factors = std::make_shared<Factors>();
  factors->prescribed = particle.rigid->prescribed;
  factors->sites = collocation_matrix(*particle.space);
  std::vector<int> all(static_cast<std::size_t>(particle.space->n_points));
  std::iota(all.begin(), all.end(), 0);
  stokes::Rows<double> matrix;
  const spline::Space& space = *particle.space;
  stokes::Layer double_layer(stokes::Layer::Kernel::double_layer, space, space.collocation, quadrature);
  double_layer.place(own);
  double_layer.assemble(all, matrix);  // -H of the factor -1
  stokes::Layer layer(stokes::Layer::Kernel::single_layer, space, space.collocation, quadrature);
  layer.place(own);
  const Vec3 centre = bodies.rest_centre(p);
  for (int k = 0; k < 6; ++k) {
    Net field = rigid_velocity(own, unit_motion(k), centre), at_sites = factors->sites * field;
    if (factors->prescribed) {
      layer.apply(field / particle.radius, all, at_sites);
      at_sites += factors->sites * bodies.lacking(p, k) / particle.radius;
    }
    matrix += Eigen::Map<const Eigen::VectorXd>(at_sites.data(), at_sites.size()) * bodies.mean_functional(p, k).transpose();
  }
  factors->inverse = DenseFactors(matrix).inverse();
  return factors;
}

const OneBodyInverses::Use* OneBodyInverses::of_particle(std::size_t p) const {
  const auto use = std::ranges::find(factors_, p, &Use::particle);
  return use == factors_.end() ? nullptr : &*use;
}

void OneBodyInverses::take_to_sites(Net& y) const {
  for (const auto& [particle, block, factors] : factors_) block.rows(y) = factors->sites * Net(block.rows(y));
}

void OneBodyInverses::solve(const RigidParticles& placed, Net& y) const {
  for (const auto& [particle, block, factors] : factors_) {
    const Mat3 turn = placed.turn(particle);
    const Net right = block.rows(y) * turn;
    const Eigen::VectorXd solution = factors->inverse * Eigen::Map<const Eigen::VectorXd>(right.data(), right.size());
    block.rows(y) = Eigen::Map<const Net>(solution.data(), right.rows(), 3) * turn.transpose();
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

}  // namespace tanktread::coupling
