#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "spline/iga.hpp"
#include "spline/polar.hpp"

namespace tanktread::surface {

/// Options `Surface/*` of the deck: the spline space of the particle's surface. Keys of the mesh that is not selected (cube or polar) are not set.
struct MeshOptions {
  std::string mesh = "cube";  ///< cube, polar

  std::optional<int> elements_per_side;             ///< number n of elements along each edge of the cube
  /// rule at the eight points of the cube mesh where three elements meet: g1, catmull-clark
  std::optional<std::string> extraordinary_points;

  std::optional<int> azimuthal_elements, meridional_elements;  ///< numbers of elements of the polar mesh: m around the axis, r from pole to pole
  std::optional<std::string> pole_axis;                        ///< body-fixed axis of the particle on which the poles lie
  std::optional<std::string> poles;                            ///< rule at the poles: bezier transform, plain, c1
  bool fits_tightly = false;  ///< true if the surface is that of a rigid particle that fills more than three quarters of a duct's width
  bool of_cylinder = false;  ///< true if the surface is a cylinder (Particle/shape `cylinder`); it then has `azimuthal_elements` and `axial_elements`
  std::optional<int> axial_elements;                           ///< number of elements along the period of a cylinder
  /// number of bisections in azimuth of the elements at the poles, before they are transformed to non-degenerate pieces
  std::optional<int> pole_subdivisions;

  void declare(deck::Section& section);

  /// Throws UserError if keys contradict each other.
  void check() const;

  bool operator==(const MeshOptions&) const = default;
  bool polar() const { return mesh == "polar"; }
  spline::PolarMesh polar_mesh() const;
  int axis() const { return pole_axis.value()[1] - '1'; }

  double n_points() const;    ///< returns the number of control points of the mesh
  double n_elements() const;  ///< returns the number of elements of its T-mesh
};

/// Options `Particle/initial shape` of the deck: the shape at the start of a run, if it is not the resting shape. Exactly one of `map`, `stretch`,
/// `file` and `run` is set.
struct InitialShape {
  std::optional<Mat3> map;          ///< linear map applied to the resting shape about its centre
  std::optional<Vec3> stretch;      ///< factors of a linear map that stretches the resting shape along the particle's body-fixed axes
  std::optional<std::string> file;  ///< path of a Bezier-extraction file with a surface on the particle's mesh
  std::optional<std::string> run;   ///< path of the results of another run, or of one of its snapshots
  std::optional<int> mode;          ///< index, from 1, of a mode in the spectrum of `run`; this mode is added to the shape
  double mode_amplitude = 0.01;     ///< largest displacement by the added mode, divided by the particle radius R_C
  /// volume that the particle starts with and keeps: `resting` (of the resting shape) or `own` (of the initial shape)
  std::string volume = "resting";
  /// Rigid motion x -> turn x + shift of a shape from `file` or `run`, for copies of a particle; the identity for other particles
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();

  void declare(deck::Section& section);

  /// Throws UserError unless exactly one of `map`, `stretch`, `file` and `run` is given and valid.
  void check() const;

  /// Returns the linear map from the resting shape to the initial shape as a matrix in space-fixed axes: `map`, or the map that stretches by the
  /// factors `stretch` along the columns of `rotation`. Returns nothing if the shape is read from a file or run.
  std::optional<Mat3> affine(const Mat3& rotation) const;
};

/// Options `Particle/*` of the deck that give the resting shape and the initial shape of the particle.
struct ParticleShape {
  std::string shape = "sphere";     ///< sphere, spheroid, ellipsoid, red cell, cylinder, file
  std::optional<double> radius;     ///< radius of the sphere or cylinder, or of the disc of a red cell; not set for other shapes
  std::optional<std::string> axis;  ///< periodic direction along which a cylinder lies; not set for other shapes
  std::optional<Vec3> semi_axes;    ///< semi-axes of a spheroid or ellipsoid along its body-fixed x1, x2, x3; not set for other shapes
  std::optional<std::string> file;  ///< path of the Bezier-extraction file with surface and spline space; set for the shape `file`
  Vec3 center = Vec3::Zero();       ///< centre of the resting shape
  Vec3 orientation = Vec3::Zero();  ///< rotation vector (axis times angle) in degrees from the space-fixed axes to the body-fixed axes
  std::optional<InitialShape> initial;  ///< initial shape; if not set, the resting shape

  void declare(deck::Section& section);

  /// Throws UserError if keys contradict each other.
  void check() const;

  /// Surface read from the file, without `center` and `orientation` applied; null for the other shapes.
  std::shared_ptr<const spline::SplineSurface> imported;

  /// Returns whether all keys of the resting shape are equal to the keys of `other`.
  bool same_rest(const ParticleShape& other) const;

  /// Returns the rotation matrix whose columns are the particle's body-fixed axes.
  Mat3 rotation() const;

  /// Reads `imported` if the shape is `file`. Throws UserError if the file does not contain a closed surface.
  void read();

  /// Returns whether the size of the particle is known: its keys are set, or the file with the shape has been read.
  bool sized() const;

  /// Returns the particle radius R_C, the radius of the sphere of equal volume.
  double equivalent_radius() const;

  /// Returns the radius of a sphere around the centre that contains the resting shape. If the initial shape is a linear map of the resting shape, the
  /// sphere contains the initial shape instead.
  double circumscribed_radius() const;
};

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
  std::optional<std::string> points;     ///< path of the file with the factors that scale the cross-section; set for the profile `file`
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

/// Options `Tube/*` of the deck: a straight tube along x1 around the particle, with a constant cross-section in the plane x2 x3. Keys of
/// cross-sections that are not selected are not set.
struct TubeOptions {
  bool present = false;  ///< true if the deck has a tube or channel; otherwise all other members are ignored

  std::string section = "circle";            ///< cross-section: circle, ellipse, rectangle, file
  std::optional<double> radius;              ///< radius of the circle; default 1
  std::optional<Eigen::Vector2d> semi_axes;  ///< semi-axes of the ellipse along x2 and x3
  std::optional<Eigen::Vector2d> sides;      ///< sides of the rectangle along x2 and x3
  std::optional<std::string> outline;        ///< path of the file with the points of the outline; set for the cross-section `file`

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
  std::string list() const { return channel ? "Channel" : "Tube"; }

  void declare(deck::Section& section);

  /// Throws UserError if keys contradict each other or are missing.
  void check() const;

  /// Returns the smallest distance of the axis from the wall at the inlet; infinity if it is not known before files are read.
  double half_width() const;

  /// Returns whether the duct flow is computed in closed form or by a series; otherwise it is computed by boundary elements.
  bool exact_flow() const { return section != "file" && flow == "exact"; }
};

}  // namespace tanktread::surface
