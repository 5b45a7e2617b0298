#pragma once
// The plane wall or plates of a scene: `Wall/*` of the deck.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "stokes/flow/flow_options.hpp"
#include "stokes/medium/periodic_images.hpp"
#include "stokes/medium/plane_wall.hpp"

namespace tanktread {

struct ParticleScene;

struct WallOptions {
  bool present = false;  ///< true if there is a wall; otherwise the other members are not used

  std::string shape = "plane";
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  std::optional<double> distance;                 ///< distance of a second plate from the first, along the normal; not set if there is one plate
  /// velocities of the first and the second plate; a plate whose velocity is not set moves with the ambient flow
  std::optional<Vec3> velocity, second_velocity;
  std::optional<int> elements_per_period;         ///< number of elements of a plate along the longer of its two periods
  bool solid = false;         ///< true if the walls are meshed plates in a periodic cell, with unknown tractions; false if the wall acts by images
  double contact_gap = 1e-3;  ///< smallest allowed gap, divided by the radius R_C; the run ends if a gap is smaller

  void declare(deck::Section& section);

  /// Throws UserError if the normal is zero, if the flow is not tangential to the walls and uniform on them, or if the cell does not repeat along
  /// both directions in the walls. The message is one sentence. `cell`: periodic cell of the scene, if any.
  void check(const stokes::FlowOptions& flow, const std::optional<stokes::PeriodicCell>& cell) const;

  void reject(const ParticleScene& particle_scene, Rejections& to) const;  ///< adds to `to` the combinations of keys that are not allowed with a wall

  std::optional<stokes::PlaneWall> plane() const;  ///< returns the wall if it acts by images, otherwise nothing
  std::vector<stokes::PlaneWall> planes() const;   ///< returns the walls: none, one or two
  std::optional<stokes::Plates> plates() const;    ///< returns the plates if the walls are plates in a periodic cell, otherwise nothing

  /// Returns the numbers of elements of a plate along the two periods. By default the length of an element is a twelfth of the distance of the
  /// plates, or a twelfth of `radius` if there is only one plate, but a period has at least 4 and at most 72 elements.
  std::array<int, 2> elements(const stokes::PeriodicCell& cell, double radius) const;
};

}  // namespace tanktread
