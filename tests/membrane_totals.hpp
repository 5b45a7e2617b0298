#pragma once
// Energy and tensions of a whole membrane, from the values that the library returns for its elements.

#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "base/indices.hpp"
#include "membrane/membrane.hpp"

namespace tanktread::membrane {

/// Returns the energy of the given elements.
inline double energy(const Membrane& membrane, const Net& x, std::span<const int> elements) {
  const std::vector<double> energies = membrane.element_energies(x, elements);
  return std::accumulate(energies.begin(), energies.end(), 0.);
}
inline double energy(const Membrane& membrane, const Net& x) { return energy(membrane, x, indices(membrane.space().elements.size())); }

/// Returns the summary of the tensions of all elements.
inline TensionSummary tension_summary(const Membrane& membrane, const Net& x) {
  const ElementTensions all = membrane.element_tensions(x, indices(membrane.space().elements.size()));
  const auto sum = [](const std::vector<double>& areas) { return std::accumulate(areas.begin(), areas.end(), 0.); };
  return {all.smallest, sum(all.compressed) / sum(all.area), all.area_change, std::sqrt(sum(all.squared_change) / sum(all.unstressed))};
}

}  // namespace tanktread::membrane
