#pragma once
// Options of tubes and channels.

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "deck/forward.hpp"
#include "deck/table.hpp"

namespace tanktread::surface {

/// Kinds of duct. A duct of any kind is open or periodic along x1; its period determines which.
enum class DuctKind {
  straight_tube,  ///< endless straight tube along x1; the modelled part of its wall moves with the particles
  channel,        ///< duct with one inlet and one outlet whose shape may vary along a centre line; its wall is fixed in the laboratory frame
};

/// Properties of a kind of duct.
struct DuctProperties {
  const char* section;  ///< name of the section of the deck
  bool fixed;           ///< whether the wall is fixed in the laboratory frame; otherwise it moves along x1 with the particles
  /// whether the flow of the empty duct is parallel to x1. If so, v_inf and f_inf (2.7) are evaluated at the quadrature nodes of the particle.
  /// Otherwise v_inf is interpolated from the collocation points, because its values at the nodes would require integrals over the wall, and the
  /// contribution of v to dp follows from the condition of zero flow rate (2.14)
  bool parallel_flow;
  bool uses_means;      ///< whether the collocation equations of the wall use means (2.39) of the velocity
  bool may_iterate;     ///< whether Solvers/wall applies to the wall; otherwise the wall is always factored
  bool corrects_walls;  ///< whether the residual velocity on the wall contributes to the correction of forces (2.42)
};
DuctProperties properties(DuctKind kind);  ///< returns the properties of this kind

/// Options `Channel/*` of the deck that have no counterpart in the section Tube. A channel has the cross-section of a tube, scaled by factors that
/// vary along a centre line. The centre line starts along x1 and may bend.
struct ChannelOptions {
  std::string profile = "constriction";  ///< straight, constriction, expansion, step, file
  /// d, largest deviation from 1 of the factor that scales the cross-section; not set for the profiles `straight` and `file`
  std::optional<double> depth;
  /// w, half the length, along the centre line, of the part of the channel in which the cross-section is scaled by a factor other than 1
  std::optional<double> half_length;
  std::optional<double> corner_radius;   ///< radius of the rounded edges of the profile `step`
  std::string directions = "x2 x3";      ///< directions in which the cross-section is scaled
  std::optional<deck::TableFile> points;  ///< path of the file with the factors that scale the cross-section; set for the profile `file`
  std::optional<double> bend_radius;     ///< radius of the arc of the centre line; not set for a straight centre line
  double bend_start = 0, bend_angle = 90;  ///< bend_start: arc length s of the centre line at which the arc begins (up to there, s = x1). bend_angle:
                                           ///< angle of the arc, from x1 towards x2, degrees
  std::optional<double> start, end;      ///< arc lengths s of the centre line at which the computed part of the channel begins and ends; if not set,
                                         ///< 4 R_T before the first and after the last change of cross-section or direction (R_T: radius of the
                                         ///< circle with the area of the inlet)
  std::optional<int> axial_elements;     ///< number of elements along the wall; if not set, it is chosen from the shape of the wall

  void declare(deck::Section& list);
  void check() const;
};

inline const std::vector<std::string> duct_sections{"circle", "ellipse", "rectangle", "file"};  ///< words for `section` of tubes and channels

/// Options `Tube/*` of the deck: a straight tube along x1 around the particle, with a constant cross-section in the plane x2 x3. Keys of
/// cross-sections that are not selected are not set.
struct TubeOptions {
  bool present = false;  ///< true if the deck has a tube or channel; otherwise all other members are ignored

  std::string section = "circle";            ///< cross-section: one of duct_sections
  std::optional<double> radius;              ///< radius of the circle; default 1
  std::optional<Eigen::Vector2d> semi_axes;  ///< semi-axes of the ellipse along x2 and x3
  std::optional<Eigen::Vector2d> sides;      ///< sides of the rectangle along x2 and x3
  std::optional<deck::TableFile> outline;    ///< path of the file with the points of the outline; set for the cross-section `file`

  std::optional<double> length;  ///< length of the wall; default: the larger of 2 pi R_T and the particle's length plus 4.6 R_T (R_T: tube radius)
  double period = 0;  ///< period of the duct along x1, from the section Domain or from `periodic_length`; 0 if the duct is not periodic
  /// period L along x1 of tube and particles; not set if the tube is not periodic, or if the section Domain gives the period
  std::optional<double> periodic_length;
  /// number M of periodic images; has no effect, because the kernels of a periodic tube contain all images
  std::optional<int> images;
  int azimuthal_elements = 24;   ///< number of elements around the wall
  /// number of elements along the wall, or along one period; a wall with ends has three more rows of control points
  std::optional<int> axial_elements;
  /// Returns the number of elements along a wall with ends if `axial_elements` is not set: 25 if there are 24 around, otherwise in proportion.
  double default_axial_elements() const { return azimuthal_elements * 25. / 24; }
  /// Returns the number of elements along a straight wall with ends.
  int elements_along() const { return axial_elements.value_or(static_cast<int>(std::ceil(default_axial_elements()))); }
  double grading = 4;            ///< density of elements along the tube near the particle, divided by the density far from it

  /// smallest allowed gap between particle and wall, divided by the particle radius R_C; a run stops if the gap is smaller
  double contact_gap = 0.02;

  /// force per unstressed area by which the wall repels a membrane if the gap is zero; not set if there is no repulsion
  std::optional<double> repulsion;
  std::optional<double> repulsion_range;  ///< increase of the gap over which the repulsive stress decreases by a factor of e

  std::string flow = "exact";  ///< method for the duct flow: exact (closed form or series, if known for the cross-section), boundary elements
  int flow_elements = 96;      ///< number of boundary elements for the duct flow

  /// options that only a channel has; if set, the deck has a section Channel, not Tube. It has the keys of `channel` and the keys of this structure
  /// except `length`, `periodic length`, `images`, `axial elements` and `grading`
  std::optional<ChannelOptions> channel;
  DuctKind kind() const { return channel ? DuctKind::channel : DuctKind::straight_tube; }
  std::string list() const { return properties(kind()).section; }  ///< returns the name of the section of the deck

  void declare(deck::Section& section);

  /// Throws UserError if keys contradict each other or are missing.
  void check() const;

  /// Returns the smallest distance of the axis from the wall at the inlet; infinity if it is not known before files are read.
  double half_width() const;

  /// Returns whether the duct flow is computed in closed form or by a series; otherwise it is computed by boundary elements.
  bool exact_flow() const;
};

}  // namespace tanktread::surface
