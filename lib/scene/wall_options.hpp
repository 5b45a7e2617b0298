#pragma once
// The plane wall of a scene: `Wall/*` of the deck.

#include <optional>
#include <string>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "stokes/flow/flow_options.hpp"
#include "stokes/medium/plane_wall.hpp"

namespace tanktread {

struct Scene;

struct WallOptions {
  bool present = false;  ///< true if there is a wall; otherwise the other members are not used

  std::string shape = "plane";
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  double contact_gap = 1e-3;  ///< gap divided by R_C; the run ends if the gap is smaller

  void declare(deck::Section& section);

  /// Throws UserError, with one sentence, if the normal is zero, or if the flow does not fit the wall: it must be parallel to the wall and uniform on
  /// it.
  void check(const stokes::FlowOptions& flow) const;

  void reject(const Scene& scene, Rejections& to) const;  ///< adds the combinations of keys that a wall excludes

  std::optional<stokes::PlaneWall> plane() const;  ///< returns the wall, if there is one
};

}  // namespace tanktread
