#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "spline/extraction.hpp"
#include "spline/iga.hpp"
#include "spline/polar.hpp"

namespace tanktread::surface {

/// Options `Surface/*` of the deck: the spline space of the particle's surface. Keys of the mesh that is not selected (cube or polar) are not set.
struct MeshOptions {
  std::string mesh = "cube";  ///< cube, polar

  std::optional<int> elements_per_side;                           ///< number n of elements along each edge of the cube
  std::optional<spline::ExtraordinaryRule> extraordinary_points;  ///< rule at the eight points of the cube mesh where three elements meet

  std::optional<int> azimuthal_elements, meridional_elements;  ///< numbers of elements of the polar mesh: m around the axis, r from pole to pole
  std::optional<std::string> pole_axis;                        ///< body-fixed axis of the particle on which the poles lie
  std::optional<spline::PoleRule> poles;                       ///< rule at the poles of the polar mesh
  bool fits_tightly = false;  ///< true if the particle is rigid and fills more than three quarters of a duct's width
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
  /// Returns whether the surface has a normal at every pole; true for the cube mesh, which has no poles.
  bool has_normal_at_poles() const { return !polar() || spline::properties(poles.value()).has_normal; }
  /// Returns whether elements at poles are replaced by pieces that are not elements of the mesh; false for the cube mesh.
  bool replaces_elements() const { return polar() && spline::properties(poles.value()).replaces_elements; }
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
  std::optional<std::string> particle;  ///< name of the particle of `run`, if it has several; if not set, the particle of the same name
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

inline const std::vector<std::string> particle_shapes{"sphere", "spheroid", "ellipsoid", "red cell", "cylinder", "file"};  ///< words for `shape`

/// Options `Particle/*` of the deck that give the resting shape. All keys of the resting shape are members of this structure, because
/// ParticleShape::same_rest() compares its members only.
struct RestingShape {
  std::string shape = "sphere";     ///< one of particle_shapes
  std::optional<double> radius;     ///< radius of the sphere or cylinder, or of the disc of a red cell; not set for other shapes
  std::optional<std::string> axis;  ///< periodic direction along which a cylinder lies; not set for other shapes
  std::optional<Vec3> semi_axes;    ///< semi-axes of a spheroid or ellipsoid along its body-fixed x1, x2, x3; not set for other shapes
  std::optional<std::string> file;  ///< path of the Bezier-extraction file with surface and spline space; set for the shape `file`
  Vec3 center = Vec3::Zero();       ///< centre of the resting shape
  Vec3 orientation = Vec3::Zero();  ///< rotation vector (axis times angle) in degrees from the space-fixed axes to the body-fixed axes

  bool operator==(const RestingShape&) const = default;
};

/// Options `Particle/*` of the deck that give the resting shape and the initial shape of the particle.
struct ParticleShape : RestingShape {
  std::optional<InitialShape> initial;  ///< initial shape; if not set, the resting shape

  void declare(deck::Section& section);

  /// Throws UserError if keys contradict each other.
  void check() const;

  /// Returns whether the particle is a sphere or a red cell, which are determined by `radius` and have the axis of revolution x3.
  bool round() const { return shape == "sphere" || shape == "red cell"; }

  /// Returns whether the shape is a linear image of the unit sphere.
  bool ellipsoidal() const { return shape == "sphere" || shape == "spheroid" || shape == "ellipsoid"; }

  /// Surface read from the file, without `center` and `orientation` applied; null for the other shapes.
  std::shared_ptr<const spline::SplineSurface> imported;

  bool operator==(const ParticleShape&) const = delete;

  /// Returns whether all keys of the resting shape are equal to the keys of `other`.
  bool same_rest(const RestingShape& other) const { return RestingShape::operator==(other); }

  /// Returns the rotation matrix whose columns are the particle's body-fixed axes.
  Mat3 rotation() const;

  /// Reads `imported` if the shape is `file`. Throws UserError if the file does not contain a closed surface.
  void read();

  /// Returns whether the size of the particle is known: its keys are set, or the file with the shape has been read. The sizes below are used before
  /// check(). For keys with which they have no meaning, the result must therefore be false.
  bool sized() const;

  /// Returns the particle radius R_C, the radius of the sphere of equal volume.
  double equivalent_radius() const;

  /// Returns the exact volume of the shape whose volume the particle keeps during a run. (The run keeps the volume of this shape on its mesh,
  /// Body::volume.) Returns nothing if it is the volume of an initial shape from a file or run.
  std::optional<double> exact_volume() const;

  /// Returns the radius of a sphere around the centre that contains the resting shape. If the initial shape is a linear map of the resting shape, the
  /// sphere contains the initial shape instead.
  double circumscribed_radius() const;
};

}  // namespace tanktread::surface
