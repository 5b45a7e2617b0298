#include "system/particle.hpp"

#include <algorithm>

#include "base/formatted.hpp"
#include "base/indices.hpp"

namespace tanktread::coupling {

void set_blocks(std::span<Particle> particles) {
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

std::vector<bool> loads_per_current_area(std::span<const Particle> particles) {
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

double viscosity_contrast(const Particle& particle) {
  if (particle.rigid) return particle.by_traction ? 0 : -1;
  return 1 - particle.viscosity_ratio;
}

std::vector<double> viscosity_contrasts(std::span<const Particle> particles) {
  std::vector<double> result;
  if (std::ranges::all_of(particles, [](const Particle& particle) { return viscosity_contrast(particle) == 0; })) return result;
  for (const Particle& particle : particles) result.insert(result.end(), particle.block.n_elements, viscosity_contrast(particle));
  return result;
}

std::vector<Block> blocks_of_particles(std::span<const Particle> particles) {
  std::vector<Block> blocks;
  for (const Particle& one : particles) {
    const int p = static_cast<int>(blocks.size());
    const std::string name = particles.size() == 1 ? "velocity" : formatted("velocity of particle %d", p + 1);
    blocks.push_back({.name = name, .on = p, .rows = one.block.n_points});
  }
  return blocks;
}

void clear_rigid(std::span<const Particle> particles, Net& net) {
  for (const Particle& one : particles)
    if (one.rigid) one.block.rows(net).setZero();
}

namespace {

/// Adds the virtual work of one particle, which the function `add` computes, to the rows of this particle in `work`.
template <class Add>
void add_rows(const spline::Block& block, Net& work, const Add& add) {
  Net own = Net::Zero(block.n_points, 3);
  add(own);
  block.rows(work) += own;
}

}  // namespace

Loads::Loads(std::span<const Particle> particles, std::span<const int> elements) {
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const spline::Block& block = particles[p].block;
    const auto first = std::ranges::lower_bound(elements, block.first_element);
    std::vector<int> own(first, std::ranges::lower_bound(first, elements.end(), block.first_element + block.n_elements));
    for (int& element : own) element -= block.first_element;
    std::size_t next = 0;
    for (const auto& load : particles[p].loads) {
      all_.push_back({p, block, own, load, next});
      next += load->n_sums();
    }
    n_sums_ = std::max(n_sums_, next);
  }
}

std::vector<Net> Loads::One::own(const std::vector<Net>& sums) const {
  std::vector<Net> rows;
  for (std::size_t s = first_sum; s < first_sum + load->n_sums(); ++s) rows.emplace_back(block.rows(sums[s]));
  return rows;
}

std::vector<Net> Loads::add_work(const Net& x, Net& work) const {
  std::vector<Net> sums(n_sums_, Net::Zero(x.rows(), 3));
  for (const One& one : all_) {
    std::vector<Net> own = one.own(sums);
    add_rows(one.block, work, [&](Net& rows) { one.load->add_work(one.block.rows(x), one.elements, rows, own); });
    for (std::size_t s = 0; s < own.size(); ++s) one.block.rows(sums[one.first_sum + s]) = own[s];
  }
  return sums;
}

void Loads::add_global_work(const Net& x, const std::vector<Net>& sums, Net& work) const {
  for (const One& one : all_)
    add_rows(one.block, work, [&](Net& rows) { one.load->add_global_work(one.block.rows(x), one.own(sums), rows); });
}

double Loads::energy(const Net& x, const std::vector<Net>& sums, std::size_t p) const {
  double energy = 0;
  for (const One& one : all_)
    if (one.particle == p && one.load->stores()) energy += one.load->energy(one.block.rows(x), one.own(sums));
  return energy;
}

void Loads::add_stored_work(const Net& x, Net& work) const {
  for (const One& one : all_) {
    if (!one.load->stores()) continue;
    const std::vector<int> elements = indices(one.block.n_elements);
    std::vector<Net> sums(one.load->n_sums(), Net::Zero(one.block.n_points, 3));
    const Net own = one.block.rows(x);
    add_rows(one.block, work, [&](Net& rows) {
      one.load->add_work(own, elements, rows, sums);
      one.load->add_global_work(own, sums, rows);
    });
  }
}

void Loads::linearise(const Net& x, const std::vector<Net>& sums) {
  for (const One& one : all_) one.load->linearise(one.block.rows(x), one.elements, one.own(sums));
}

void Loads::add_tangent(const Net& dx, Net& change) const {
  for (const One& one : all_) add_rows(one.block, change, [&](Net& rows) { one.load->add_tangent(one.block.rows(dx), rows); });
}

void Loads::add_global_tangent(const Net& dx, Net& change) const {
  for (const One& one : all_) add_rows(one.block, change, [&](Net& rows) { one.load->add_global_tangent(one.block.rows(dx), rows); });
}

}  // namespace tanktread::coupling
