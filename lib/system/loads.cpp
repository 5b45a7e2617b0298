#include "system/loads.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tanktread::coupling {

namespace {

/// Adds the work that `add` gives in the rows of a particle.
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
    std::vector<int> elements(static_cast<std::size_t>(one.block.n_elements));
    std::iota(elements.begin(), elements.end(), 0);
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
