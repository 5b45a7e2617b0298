#pragma once

#include <string>
#include <vector>

#include "deck/forward.hpp"

namespace tanktread::quadrature {

/// Quadrature rule of layer integrals. `adaptive`: number of Gauss points chosen by Options::tolerance. `fixed`: Options::points x Options::points
/// Gauss points, with the map of Lachat and Watson on panels that contain the target. `desingularised`: these Gauss points on all panels, with the
/// singularity subtracted by identities. What distinguishes the rules is in stokes/sums/layer_rule.hpp.
enum class LayerRule { adaptive, fixed, desingularised };

inline const std::vector<std::string> layer_rules{"adaptive", "fixed", "desingularised"};  ///< words for LayerRule in decks

/// Options of the quadrature of layer integrals: `Quadrature/*` of the deck.
struct Options {
  double tolerance = 1e-4;        ///< relative accuracy of every layer integral: singular, near-singular and far
  LayerRule rule = LayerRule::adaptive;
  int points = 8;                 ///< Gauss points per direction of the rules `fixed` and `desingularised`
  std::string far_sum = "auto";   ///< `dense`: sums over all far nodes; `tree`: sums over clusters of nodes; `auto`: the faster one

  /// Replaces the value `auto` of the key `far sum` by `dense`. Sums by clusters jump when clusters change with the shape. Finite differences with
  /// small displacements, as for a spectrum, amplify the jumps: with `auto`, the leading growth rate of a capsule was wrong by 1 to 25 %.
  /// Searches for steady shapes stop converging when corrections are as small as the jumps: 3e-8 for a drop between plates.
  void choose_smooth_sums();

  /// Returns options with a smaller tolerance, for single-layer matrices and integrals of walls, plates and posts that are computed only once.
  Options for_matrix() const;

  /// Returns options with a third of the tolerance, for the flows between particles and plates or posts. In long cells these flows are larger than
  /// their sum: with the tolerance itself, the drag on a sphere of radius a that moves along plates errs by 1.2e-4 at the tolerance 1e-4 (period
  /// 30 a), with a third of it by 7e-6. Sums take 5 % more time.
  Options for_response() const;

  bool operator==(const Options&) const = default;

  void declare(deck::Section& section);
};

}  // namespace tanktread::quadrature
