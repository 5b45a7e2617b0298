#include "coupling/whole_membrane.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tanktread::coupling {
namespace {

double area_stiffness(const Particle& one) { return one.global_area_modulus; }
double leaf_stiffness(const Particle& one) { return std::numbers::pi * one.leaf_modulus; }

}  // namespace

bool WholeMembrane::needed(std::span<const Particle> particles) {
  return std::ranges::any_of(particles, [](const Particle& one) { return area_stiffness(one) + leaf_stiffness(one) > 0; });
}

WholeMembrane::WholeMembrane(const spline::Space& space, const Net& unstressed, std::span<const Particle> particles) {
  const auto membrane = [&](const membrane::Law& law, const membrane::Bending& bending = {}) {
    return membrane::Membrane(space, unstressed, law, 4, bending);
  };
  Measure area{2, {}, {}}, difference{1, {}, {}};
  double radius = 1;
  for (const Particle& one : particles) {
    area.particles.push_back({one.block, area_stiffness(one) + leaf_stiffness(one), 0});  // both need A0
    difference.particles.push_back({one.block, leaf_stiffness(one), 0});
    if (one.leaf_modulus > 0) radius = one.radius;
  }
  area.parts.emplace_back(1.0, membrane(membrane::SurfaceTension{1}));
  for (const double sign : {-1.0, 1.0})  // (2 chi + c)^2/2 - (2 chi - c)^2/2 is 4 chi c, here of c = 1/R
    difference.parts.emplace_back(-sign, membrane(membrane::SurfaceTension{0}, {radius / 2, false, sign / radius}));

  std::vector<int> all(space.elements.size());
  std::iota(all.begin(), all.end(), 0);
  const Net a = area.gradient_at(unstressed, all), n = difference.gradient_at(unstressed, all);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Particle& one = particles[p];
    if (area.particles[p].stiffness == 0) continue;
    const double area0 = area(unstressed, a, one.block), of_sphere = 4 * std::sqrt(std::numbers::pi * area0);  // its N, 8 pi R
    area.particles[p] = {one.block, area_stiffness(one) / area0, area0};
    difference.particles[p] = {one.block, leaf_stiffness(one) / area0,
                               one.leaf_difference ? *one.leaf_difference * of_sphere : difference(unstressed, n, one.block)};
  }
  for (Measure* const measure : {&area, &difference}) {
    if (std::ranges::none_of(measure->particles, [](const Of& one) { return one.stiffness > 0; })) continue;
    measures_.push_back(std::move(*measure));
  }
  for (Measure& measure : measures_)
    for (const auto& part : measure.parts) measure.tangents.emplace_back(part.second);
}

/// Of `elements` those of particles that resist.
std::vector<int> WholeMembrane::Measure::mine(std::span<const int> elements) const {
  std::vector<int> result;
  for (const Of& one : particles) {
    if (one.stiffness == 0) continue;
    const auto first = std::ranges::lower_bound(elements, one.block.first_element);
    result.insert(result.end(), first, std::ranges::lower_bound(first, elements.end(), one.block.first_element + one.block.n_elements));
  }
  return result;
}

Net WholeMembrane::Measure::gradient_at(const Net& x, std::span<const int> elements) const {
  Net result = Net::Zero(x.rows(), 3), part(x.rows(), 3);
  const std::vector<int> own = mine(elements);
  for (const auto& [factor, membrane] : parts) {
    membrane.load(x, own, part);
    result += factor * part;
  }
  return result;
}

std::vector<Net> WholeMembrane::gradients(const Net& x, std::span<const int> elements) const {
  std::vector<Net> result;
  for (const Measure& measure : measures_) result.push_back(measure.gradient_at(x, elements));
  return result;
}

double WholeMembrane::energy(const Net& x, const std::vector<Net>& q, std::size_t p) const {
  double result = 0;
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    const Of& one = measures_[m].particles[p];
    const double change = measures_[m](x, q[m], one.block) - one.relaxed;
    result += one.stiffness * change * change / 2;
  }
  return result;
}

void WholeMembrane::add_load(const Net& x, const std::vector<Net>& q, Net& d) const {
  for (std::size_t m = 0; m < measures_.size(); ++m)
    for (const Of& one : measures_[m].particles)
      one.block.rows(d) += one.stiffness * (measures_[m](x, q[m], one.block) - one.relaxed) * one.block.rows(q[m]);
}

void WholeMembrane::update(const Net& x, std::vector<Net> q, std::span<const int> elements) {
  for (std::size_t m = 0; m < measures_.size(); ++m) {
    Measure& measure = measures_[m];
    const std::vector<int> own = measure.mine(elements);
    for (membrane::Tangent& tangent : measure.tangents) tangent.update(x, own);
    for (Of& one : measure.particles) one.tension = one.stiffness * (measure(x, q[m], one.block) - one.relaxed);
    measure.q = std::move(q[m]);
  }
}

void WholeMembrane::add_turning(const Net& u, Net& hu) const {
  Net turned(u.rows(), 3);
  for (const Measure& measure : measures_)
    for (std::size_t k = 0; k < measure.parts.size(); ++k) {
      measure.tangents[k].apply(u, turned);
      for (const Of& one : measure.particles) one.block.rows(hu) += one.tension * measure.parts[k].first * one.block.rows(turned);
    }
}

void WholeMembrane::add_stretching(const Net& u, Net& hu) const {
  for (const Measure& measure : measures_)
    for (const Of& one : measure.particles)
      one.block.rows(hu) += one.stiffness * one.block.rows(measure.q).cwiseProduct(one.block.rows(u)).sum() * one.block.rows(measure.q);
}

}  // namespace tanktread::coupling
