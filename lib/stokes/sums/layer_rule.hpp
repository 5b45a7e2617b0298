#pragma once
// Properties of the quadrature rules that a deck can choose for layer integrals.

#include <stdexcept>

#include "quadrature/options.hpp"

namespace tanktread::stokes {

struct RuleProperties {
  /// The orders of the far rule and of the singular rules follow from Options::tolerance. Otherwise they are Options::points.
  bool follows_tolerance;
  /// Panels close to a target get near-singular rules (NearField). Otherwise only the far rule is used on them.
  bool corrects_near;
  /// Panels that contain a target get singular rules (SelfField). Otherwise only the far rule is used on them, and the single layer is corrected by
  /// identities of a closed surface (stokes/closed_surface_identities.hpp).
  bool has_singular_rules;
};

/// Returns the properties of a rule. The compiler warns if the switch omits a rule.
inline RuleProperties properties(quadrature::LayerRule rule) {
  switch (rule) {
    case quadrature::LayerRule::adaptive: return {.follows_tolerance = true, .corrects_near = true, .has_singular_rules = true};
    case quadrature::LayerRule::fixed: return {.follows_tolerance = false, .corrects_near = false, .has_singular_rules = true};
    case quadrature::LayerRule::desingularised: return {.follows_tolerance = false, .corrects_near = false, .has_singular_rules = false};
  }
  throw std::logic_error("unknown LayerRule");
}

}  // namespace tanktread::stokes
