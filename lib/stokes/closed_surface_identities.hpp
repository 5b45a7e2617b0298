#pragma once
// Corrections of the quadrature rule `desingularised` (Layer).

#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer_sources.hpp"
#include "stokes/medium/layer_medium.hpp"

namespace tanktread::stokes {

/// Subtract the quadrature error of two identities of a closed surface from the single layer that the Gauss nodes give at `sites`: from its values u
/// for the density of `sources`; from its assembled rows `a`; or from the blocks `entries` of near control points (Layer::assemble).
void subtract_identities(LayerSources& sources, std::span<const int> sites, Net& u);
template <class Real>
void subtract_identities(const LayerSources& sources, std::span<const int> sites, Rows<Real>& a);
void subtract_identities(const LayerSources& sources, std::span<const int> sites, const NearPoints& near, std::vector<double>& entries);

}  // namespace tanktread::stokes
