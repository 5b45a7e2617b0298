#pragma once
// Properties of the quadrature rules that a deck can choose for layer integrals.

#include <stdexcept>

#include "quadrature/options.hpp"

namespace tanktread::stokes {

/// Returns whether the orders of the far rule and of the singular rules follow from Options::tolerance. Otherwise they are Options::points.
inline bool follows_tolerance(quadrature::LayerRule rule) {
  switch (rule) {
    case quadrature::LayerRule::adaptive: return true;
    case quadrature::LayerRule::fixed: return false;
    case quadrature::LayerRule::desingularised: return false;
  }
  throw std::logic_error("unknown LayerRule");
}

/// Returns whether panels close to a target get near-singular rules (NearField). Otherwise only the far rule is used on them.
inline bool corrects_near(quadrature::LayerRule rule) {
  switch (rule) {
    case quadrature::LayerRule::adaptive: return true;
    case quadrature::LayerRule::fixed: return false;
    case quadrature::LayerRule::desingularised: return false;
  }
  throw std::logic_error("unknown LayerRule");
}

/// Returns whether panels that contain a target get singular rules (SelfField). Otherwise only the far rule is used on them, and the single layer is
/// corrected by identities of a closed surface (stokes/closed_surface_identities.hpp).
inline bool has_singular_rules(quadrature::LayerRule rule) {
  switch (rule) {
    case quadrature::LayerRule::adaptive: return true;
    case quadrature::LayerRule::fixed: return true;
    case quadrature::LayerRule::desingularised: return false;
  }
  throw std::logic_error("unknown LayerRule");
}

}  // namespace tanktread::stokes
