#pragma once

#include <optional>
#include <string>

#include "base/types.hpp"
#include "spline/polar.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::surface {

/// The spline space of the particle's surface: `Surface/*` of the deck.
struct MeshOptions {
  std::string mesh = "cube";                ///< 6 n^2 elements, eight extraordinary points; or polar, two poles
  int elements_per_side = 6;                ///< n
  std::string extraordinary_points = "g1";  ///< rule at points where three elements meet
  int azimuthal_elements = 32;              ///< m
  int meridional_elements = 16;             ///< r
  std::string pole_axis = "x3";             ///< the particle's own
  std::string poles = "bezier transform";   ///< rule at the poles
  int pole_subdivisions = 2;                ///< in azimuth, before the transform

  void declare(deck::Section& section);

  bool polar() const { return mesh == "polar"; }
  spline::PolarMesh polar_mesh() const;
  int axis() const { return pole_axis[1] - '1'; }

  /// Control points of the mesh that the deck asks for.
  double n_points() const;
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
