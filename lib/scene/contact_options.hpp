#pragma once
// Options of contacts, as read from the deck.

#include "base/rejections.hpp"
#include "deck/section.hpp"

namespace tanktread {

struct SharedOptions;

/// Options `Contact/*` of the deck: contacts between several particles or periodic images.
struct ContactOptions {
  double limit = 1e-3;  ///< smallest allowed gap, divided by the radius R_C of the smallest particle
  bool limiter = false;  ///< true if contact forces keep the gaps between particles at `limit` or above

  static constexpr double slack = 1e-2;  ///< fraction of `limit` by which gaps adjacent to a contact may be smaller than `limit`
  /// smallest gap, divided by `limit`, from which the limiter moves particles apart
  static constexpr double reach = 0.5;
  /// gap below which a run does not start, divided by the smallest radius R_C
  double start() const { return (limiter ? reach : 1) * limit; }
  double end() const { return (limiter ? 1 - 2 * slack : 1) * limit; }  ///< gap below which the run ends, divided by the smallest radius R_C

  void declare(deck::Section& section);
  void reject(const SharedOptions& shared, Rejections& to) const;
};

}  // namespace tanktread
