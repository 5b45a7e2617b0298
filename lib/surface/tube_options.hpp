#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

namespace tanktread::deck {
class Section;
}

namespace tanktread::surface {

/// The straight tube along x1 around the particle: `Tube/*` of the deck. Its section is constant, in the plane x2 x3. Keys of other sections
/// are empty.
struct TubeOptions {
  bool present = false;  ///< whether the scene has a tube at all; nothing else counts without

  std::string section = "circle";            ///< circle, ellipse, rectangle, file
  std::optional<double> radius;              ///< of the circle; 1 if not given
  std::optional<Eigen::Vector2d> semi_axes;  ///< of the ellipse, along x2 and x3
  std::optional<Eigen::Vector2d> sides;      ///< of the rectangle, along x2 and x3
  std::optional<std::string> outline;        ///< path of the file of points

  std::optional<double> length;  ///< of the wall; 2 pi R_T, or more for a long particle, if not given
  int azimuthal_elements = 24;   ///< of the wall, around
  int axial_elements = 25;       ///< of the wall, along; three more control points
  double grading = 4;            ///< density of elements along the tube, at the particle over far away

  double contact_gap = 0.02;  ///< between particle and wall, over R_C: a run that comes closer stops

  std::string flow = "exact";  ///< of the duct: exact (closed form or series, where the section has one), boundary elements
  int flow_elements = 96;      ///< boundary elements of the duct flow

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other or are missing.
  void check() const;

  /// Whether the duct flow is known in closed form or as a series.
  bool exact_flow() const { return section != "file" && flow == "exact"; }
};

}  // namespace tanktread::surface
