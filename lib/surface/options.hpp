#pragma once

#include <optional>
#include <string>

#include "base/types.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::surface {

/// The spline space of the particle's surface: `Surface/*` of the deck.
struct MeshOptions {
  std::string mesh = "cube";                ///< 6 n^2 elements, eight extraordinary points
  int elements_per_side = 6;                ///< n
  std::string extraordinary_points = "g1";  ///< rule at points where three elements meet

  void declare(deck::Section& section);
};

/// The resting shape of the particle: keys of `Particle/*`.
struct ParticleShape {
  std::string shape = "sphere";     ///< sphere, spheroid, ellipsoid, red cell
  std::optional<double> radius;     ///< of the sphere, or of the disc of a red cell; set for these two, empty otherwise
  std::optional<Vec3> semi_axes;    ///< along the particle's own x1, x2, x3; set for spheroid and ellipsoid, empty otherwise
  Vec3 center = Vec3::Zero();       ///< of the resting shape
  Vec3 orientation = Vec3::Zero();  ///< rotation vector (axis times angle) in degrees, from the particle's own axes to those of space

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other.
  void check() const;

  /// Columns: the particle's own axes in space.
  Mat3 rotation() const;

  /// R_C: radius of the sphere of equal volume.
  double equivalent_radius() const;
};

}  // namespace tanktread::surface
