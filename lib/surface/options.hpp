#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "spline/iga.hpp"
#include "spline/polar.hpp"

namespace tanktread::surface {

/// The spline space of the particle's surface: `Surface/*` of the deck. Keys of the other mesh are empty.
struct MeshOptions {
  std::string mesh = "cube";  ///< or polar

  std::optional<int> elements_per_side;             ///< n of the cube mesh
  std::optional<std::string> extraordinary_points;  ///< rule at points where three elements meet

  std::optional<int> azimuthal_elements, meridional_elements;  ///< m around, r from pole to pole, of the polar mesh
  std::optional<std::string> pole_axis;                        ///< the particle's own
  std::optional<std::string> poles;                            ///< rule at the poles
  std::optional<int> pole_subdivisions;                        ///< in azimuth, before the transform

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other.
  void check() const;

  bool operator==(const MeshOptions&) const = default;
  bool polar() const { return mesh == "polar"; }
  spline::PolarMesh polar_mesh() const;
  int axis() const { return pole_axis.value()[1] - '1'; }

  /// Control points of the mesh, and elements of its T-mesh.
  double n_points() const;
  double n_elements() const;
};

/// The shape that a run starts with where that is not the resting one: `Particle/initial shape` of the deck.
struct InitialShape {
  std::optional<Mat3> map;          ///< from the resting shape, about its centre
  std::optional<Vec3> stretch;      ///< the same, factors along the particle's own axes
  std::optional<std::string> file;  ///< Bezier-extraction text on the particle's own mesh
  std::optional<std::string> run;   ///< results of another run, or one of its snapshots
  std::optional<int> mode;          ///< of the run's spectrum, from 1, that is added to its shape
  double mode_amplitude = 0.01;     ///< its largest displacement, over R_C
  std::string volume = "resting";   ///< or own

  void declare(deck::Section& section);

  /// One sentence (UserError) unless one of the four is given, and right.
  void check() const;

  /// `map` in space, be it given as `stretch` along the axes that are the columns of `rotation`; none where the shape is read.
  std::optional<Mat3> affine(const Mat3& rotation) const;
};

/// The resting shape of the particle, and the one to start with: keys of `Particle/*`.
struct ParticleShape {
  std::string shape = "sphere";     ///< sphere, spheroid, ellipsoid, red cell, file
  std::optional<double> radius;     ///< of the sphere, or of the disc of a red cell; set for these two, empty otherwise
  std::optional<Vec3> semi_axes;    ///< along the particle's own x1, x2, x3; set for spheroid and ellipsoid, empty otherwise
  std::optional<std::string> file;  ///< of the shape `file`: Bezier-extraction text; the spline space is the file's
  Vec3 center = Vec3::Zero();       ///< of the resting shape
  Vec3 orientation = Vec3::Zero();  ///< rotation vector (axis times angle) in degrees, from the particle's own axes to those of space
  std::optional<InitialShape> initial;  ///< none: the resting shape

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other.
  void check() const;

  /// What is in the file, as it stands there; none for the other shapes.
  std::shared_ptr<const spline::SplineSurface> imported;

  /// Whether the keys of the resting shape are the same.
  bool same_rest(const ParticleShape& other) const;

  /// Columns: the particle's own axes in space.
  Mat3 rotation() const;

  /// Takes `imported` from the file, if there is one. Throws UserError when it holds no closed surface.
  void read();

  /// Whether the keys that give its size are there and the file is read.
  bool sized() const;

  /// R_C: radius of the sphere of equal volume.
  double equivalent_radius() const;

  /// Of a sphere around its centre that holds it.
  double circumscribed_radius() const;
};

/// What makes a channel of a tube: `Channel/*` of the deck beside what it shares with `Tube`. Its section is that of a tube, times factors that
/// change along a centre line, which begins along x1 and may bend.
struct ChannelOptions {
  std::string profile = "constriction";  ///< straight, constriction, expansion, step, file
  std::optional<double> depth;           ///< d: of the factor, at the middle; not of `straight` and `file`
  std::optional<double> half_length;     ///< w: from the middle to where the factor is 1
  std::optional<double> corner_radius;   ///< of the rounded edges of a `step`
  std::string directions = "x2 x3";      ///< in which the section changes
  std::optional<std::string> points;     ///< path of the file of factors
  std::optional<double> bend_radius;     ///< of the centre line's arc; none: straight
  double bend_start = 0, bend_angle = 90;  ///< where the arc begins, and what it turns by from x1 towards x2, degrees
  std::optional<double> start, end;      ///< of the modelled piece, along the centre line
  std::optional<int> axial_elements;     ///< of the wall, along; by its shape if not given

  void declare(deck::Section& list);
  void check() const;
};

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
  double period = 0;  ///< after which the duct repeats along x1, of Domain; 0: it does not
  std::optional<double> periodic_length;  ///< L: the particles repeat along x1, a train; none: they do not
  std::optional<int> images;              ///< M: copies modelled at either side; from the tolerance of integrals if not given
  int azimuthal_elements = 24;   ///< of the wall, around
  static constexpr int default_axial_elements = 25;
  std::optional<int> axial_elements;  ///< of the wall, along, or of one period; three more control points where it is open
  double grading = 4;            ///< density of elements along the tube, at the particle over far away

  double contact_gap = 0.02;  ///< between particle and wall, over R_C: a run that comes closer stops

  std::optional<double> repulsion;        ///< stress by which the wall repels a membrane that touches it; none: it does not
  std::optional<double> repulsion_range;  ///< over which that falls by e

  std::string flow = "exact";  ///< of the duct: exact (closed form or series, where the section has one), boundary elements
  int flow_elements = 96;      ///< boundary elements of the duct flow

  std::optional<ChannelOptions> channel;  ///< of the list `Channel`, which these are then the keys of
  std::string list() const { return channel ? "Channel" : "Tube"; }

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other or are missing.
  void check() const;

  /// Whether the duct flow is known in closed form or as a series.
  bool exact_flow() const { return section != "file" && flow == "exact"; }
};

}  // namespace tanktread::surface
