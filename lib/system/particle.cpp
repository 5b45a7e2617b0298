#include "system/particle.hpp"

#include <algorithm>

namespace tanktread::coupling {

void place(std::span<Particle> particles) {
  std::vector<const spline::Space*> spaces;
  for (const Particle& particle : particles) spaces.push_back(particle.space);
  const std::vector<spline::Block> blocks = spline::blocks(spaces);
  for (std::size_t p = 0; p < particles.size(); ++p) particles[p].block = blocks[p];
}

membrane::Materials materials(std::span<const Particle> particles) {
  membrane::Materials result;
  for (const Particle& particle : particles) {
    const auto known = std::ranges::find(result.all, particle.material);
    const int number = static_cast<int>(known - result.all.begin());
    if (known == result.all.end()) result.all.push_back(particle.material);
    result.of_element.insert(result.of_element.end(), static_cast<std::size_t>(particle.block.n_elements), number);
  }
  if (result.all.size() == 1) result.of_element.clear();
  return result;
}

stokes::Measure measure(std::span<const Particle> particles) {
  const stokes::Measure first = particles.front().measure;
  return std::ranges::all_of(particles, [&](const Particle& particle) { return particle.measure == first; }) ? first : stokes::Measure::by_element;
}

std::vector<bool> measured_on_present(std::span<const Particle> particles) {
  std::vector<bool> result;
  for (const Particle& particle : particles) result.insert(result.end(), particle.block.n_elements, particle.measure == stokes::Measure::current);
  return result;
}

Net measured_net(std::span<const Particle> particles, const Net& unstressed, const Net& x) {
  Net result = unstressed;
  for (const Particle& particle : particles)
    if (particle.measure == stokes::Measure::current) particle.block.rows(result) = particle.block.rows(x);
  return result;
}

double viscosity_contrast(const Particle& particle) { return particle.rigid ? -1 : 1 - particle.viscosity_ratio; }

Eigen::VectorXd viscosity_contrasts_of_points(std::span<const Particle> particles) {
  const spline::Block& last = particles.back().block;
  Eigen::VectorXd result(last.first_point + last.n_points);
  for (const Particle& particle : particles)
    result.segment(particle.block.first_point, particle.block.n_points).setConstant(viscosity_contrast(particle));
  return result;
}

std::vector<double> viscosity_contrasts(std::span<const Particle> particles) {
  std::vector<double> result;
  if (std::ranges::all_of(particles, [](const Particle& particle) { return viscosity_contrast(particle) == 0; })) return result;
  for (const Particle& particle : particles) result.insert(result.end(), particle.block.n_elements, viscosity_contrast(particle));
  return result;
}

}  // namespace tanktread::coupling
