#pragma once
// The plane wall of a scene: `Wall/*` of the deck.

#include <optional>
#include <string>

#include "base/types.hpp"
#include "stokes/flow/flow_options.hpp"
#include "stokes/medium/plane_wall.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread {

struct WallOptions {
  bool present = false;  ///< whether there is one; nothing else counts without

  std::string shape = "plane";
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  double contact_gap = 1e-3;  ///< over R_C

  void declare(deck::Section& section);

  /// One sentence (UserError) for a normal that is none, and for a flow that does not fit the wall: it must be along it and
  /// the same everywhere on it.
  void check(const stokes::FlowOptions& flow) const;

  std::optional<stokes::PlaneWall> plane() const;  ///< nothing without one
};

}  // namespace tanktread
