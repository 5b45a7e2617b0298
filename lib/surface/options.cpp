#include "surface/options.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

namespace tanktread::surface {

void MeshOptions::declare(deck::Section& section) {
  section.key(
      "mesh", mesh, deck::Choice{"cube", "polar"},
      "mesh of the particle's surface. `cube`: a cube with n x n elements on each side, n = Surface/elements per side, mapped to the "
      "shape; 6n^2 + 2 control points; the eight corners are extraordinary points. `polar`: a grid from pole to pole, with m = "
      "Surface/azimuthal elements around the pole axis and r = Surface/meridional elements from pole to pole; (r + 1)m + 2 control points; "
      "elements are narrow near the poles");
  if (polar()) {
    azimuthal_elements = 32, meridional_elements = 16, pole_axis = "x3", poles = spline::PoleRule::bezier_transform;
  } else {
    elements_per_side = fits_tightly ? 8 : 6, extraordinary_points = spline::ExtraordinaryRule::g1;
  }
  if (of_cylinder) azimuthal_elements = 24;
  section.key("elements per side", elements_per_side, deck::between(3, 200), "1",
              "number n of elements along each edge of the cube from which the surface mesh is made, which has 6n^2 elements. With 6, "
              "the Taylor parameter of a particle that stays rounded errs by about 0.1 %, lengths of pointed, folded or thin particles by 10 % or "
              "more: compare a run with 8, or use --accuracy. Elements half as long have about a sixteenth of the error once they resolve the "
              "shape. If not given: 6, or 8 for a rigid particle in a tube or channel if R_C is more than 3/4 of the distance from the axis to the wall");
  section.key(
      "extraordinary points", extraordinary_points, spline::extraordinary_rules,
      "treatment of the extraordinary points, the eight corners of the cube mesh where three elements meet instead of four. `g1`: "
      "continuous tangent planes, with elements of degree 4 around the point (constrained extraction of Maestre et al. 2017). "
      "`catmull-clark`: limit surface of Catmull and Clark's subdivision, in bicubic pieces; refinement does not change the surface");
  section.key(
      "azimuthal elements", azimuthal_elements, deck::between(4, 400), "1",
      "number m of elements around the pole axis of a polar surface mesh (32 if not given), or around a particle of the shape `cylinder` "
      "(24 if not given)");
  section.key("axial elements", axial_elements, deck::between(4, 400), "1",
              "number of elements along one period of a particle of the shape `cylinder`, which is a post; if not given, chosen such "
              "that elements are about as long as wide");
  section.key("meridional elements", meridional_elements, deck::between(4, 200), "1",
              "number r of elements from pole to pole of the polar surface mesh; 16 if not given");
  section.key("pole axis", pole_axis, deck::Choice{"x1", "x2", "x3"},
              "body-fixed axis of the particle on which the poles of the polar surface mesh lie; `x3` if not given");
  section.key("poles", poles, spline::pole_rules,
              "treatment of the poles of the polar surface mesh. `bezier transform`: degenerate elements are replaced by regular ones, as "
              "by Maestre et al. (2017); the default. `plain`: degenerate elements are kept. `c1`: tangent planes are continuous at the "
              "poles, with (r - 1)m + 6 control points for m elements around the axis and r from pole to pole");
  if (poles && spline::properties(*poles).replaces_elements) pole_subdivisions = 2;
  section.key("pole subdivisions", pole_subdivisions, deck::between(0, 4), "1",
              "number of times that the elements at the poles of the polar surface mesh are halved in azimuth before the transform of "
              "Surface/poles `bezier transform`; 2 if not given");
  if (of_cylinder)
    section.without_effect({"mesh", "elements per side", "extraordinary points", "meridional elements", "pole axis", "poles", "pole subdivisions"},
                           "on a particle of the shape `cylinder`");
}

void MeshOptions::check() const {
  const auto misplaced = [&](bool given, const char* key) {
    refuse(given, std::string("Surface/") + key, "Surface/mesh `" + mesh + "`", std::string("it belongs to `") + (polar() ? "cube" : "polar") + "`");
  };
  misplaced(polar() && elements_per_side, "elements per side");
  misplaced(polar() && extraordinary_points, "extraordinary points");
  refuse(axial_elements.has_value(), "Surface/axial elements", "Particle/shape other than `cylinder`", "it belongs to `cylinder`");
  misplaced(!polar() && azimuthal_elements, "azimuthal elements");
  misplaced(!polar() && meridional_elements, "meridional elements");
  misplaced(!polar() && pole_axis, "pole axis");
  misplaced(!polar() && poles, "poles");
  misplaced(!polar() && pole_subdivisions, "pole subdivisions");
  refuse(pole_subdivisions && !replaces_elements(), "Surface/pole subdivisions",
         "Surface/poles `" + deck::word(spline::pole_rules, poles.value_or(spline::PoleRule::c1)) + "`", "it belongs to `bezier transform`");
}

spline::PolarMesh MeshOptions::polar_mesh() const {
  return {azimuthal_elements.value(), meridional_elements.value(), poles.value(), pole_subdivisions.value_or(0)};
}

double MeshOptions::n_points() const {
  if (!polar()) return 6.0 * *elements_per_side * *elements_per_side + 2;
  const double m = *azimuthal_elements, r = *meridional_elements;
  const spline::PoleProperties pole = spline::properties(poles.value());
  return (r + 3 - 2 * pole.rows_replaced) * m + 2 * pole.points;
}

double MeshOptions::n_elements() const {
  if (!polar()) return 6.0 * *elements_per_side * *elements_per_side;
  return 1.0 * *azimuthal_elements * *meridional_elements;
}

void ParticleShape::declare(deck::Section& section) {
  section.key("shape", shape, particle_shapes,
              "resting shape of the particle. `sphere`: of Particle/radius. `spheroid`, `ellipsoid`: with Particle/semi-axes. `red cell`: "
              "the biconcave disc of Evans and Fung, with its axis along the body-fixed x3. `cylinder`: a post, which is a fixed circular "
              "cylinder along Particle/axis through the whole period of the Domain. `file`: the closed surface in Particle/file");
  section.key("file", file, deck::Choice{},
              "path of a file with the resting shape: a closed spline surface in Bezier-extraction format (.iga), with lengths in the "
              "deck's unit. The mesh of the file is the mesh of the run, and the section Surface must be left out. A relative path is "
              "looked up in the working directory, then in the directory of the deck");
  if (round() || shape == "cylinder") radius = 1.0;
  section.key("radius", radius, deck::positive(), "length",
              "radius of the `sphere` or `cylinder`, or of the disc of the `red cell`; 1 if not given. Other keys refer to R_C, the radius "
              "of the sphere with the particle's volume: for a red cell 0.7224 times the radius of the disc");
  section.key("axis", axis, deck::Choice{"x1", "x2", "x3"},
              "direction of the axis of a particle of the shape `cylinder`; the Domain must be periodic along it");
  section.key("semi-axes", semi_axes, deck::positive(), "length",
              "semi-axes of a particle of the shape `spheroid` (two of them equal) or `ellipsoid`: three numbers along the particle's "
              "body-fixed x1, x2, x3");
  section.key("center", center, deck::any(), "length", "position of the centroid of the particle's resting shape");
  section.key("orientation", orientation, deck::any(), "degrees",
              "rotation vector (axis times angle, right-hand rule) that turns the axes of space into the particle's body-fixed axes: [0, 90, 0] "
              "turns the body-fixed x3 to x1, and the body-fixed x1 to -x3");
  if (section.given("initial shape") || section.documenting()) {
    initial.emplace();
    section.section("initial shape", *initial, "initial shape of the particle; the resting shape without this section");
    if (section.documenting()) initial.reset();
  }
}

void InitialShape::declare(deck::Section& section) {
  section.key("stretch", stretch, deck::positive(), "1",
              "three factors by which the resting shape is stretched along the particle's body-fixed x1, x2, x3, about its center, to give "
              "the initial shape");
  section.key("map", map, deck::any(), "1",
              "matrix that maps the resting shape to the initial shape, about the center and in space-fixed axes: nine numbers row by row");
  section.key("file", file, deck::Choice{},
              "path of a file with the initial surface in Bezier-extraction format (.iga), on the same mesh as the particle and at the "
              "position that it is to have. A relative path is looked up in the working directory, then in the directory of the deck");
  section.key("run", run, deck::Choice{},
              "path of the results of an earlier run on the same mesh; the last shape of the particle in that run becomes the initial shape, at "
              "the same position. If that run has several particles, each particle starts from the one with its own name, unless Particle/initial "
              "shape/particle names another one. The path names a results directory, whose newest checkpoint is read, or one of its "
              "snapshots; if the mesh of that "
              "run was refined, the refined mesh is used. Surfactant and other surface fields start as in a new run. A relative path is looked "
              "up in the working directory, then in the directory of the deck");
  section.key("particle", particle, deck::Choice{},
              "name of the particle of the earlier run (Particle/initial shape/run) whose last shape becomes the initial shape, for example "
              "`cell` or, of copies, `cell 2`. If not given, the particle with the same name or, if there is one only, this one");
  section.key("mode", mode, deck::at_least(1), "1",
              "number, from 1, of an eigenmode that the earlier run (Particle/initial shape/run) computed with its section Spectrum. The mode, "
              "scaled by `mode amplitude`, is added to the shape of that run, to see how a disturbance grows; of a complex mode the real part "
              "is added");
  section.key("mode amplitude", mode_amplitude, deck::any(), "R_C",
              "largest displacement by the eigenmode Particle/initial shape/mode that is added to the shape of the earlier run, divided "
              "by R_C, the radius of the sphere with the particle's volume");
  section.key("volume", volume, deck::Choice{"resting", "own"},
              "volume of the particle during the run. `resting`: volume of the resting shape, and the initial shape is scaled to this "
              "volume. `own`: volume of the initial shape as given");
}

void InitialShape::check() const {
  if (map.has_value() + stretch.has_value() + file.has_value() + run.has_value() != 1)
    throw UserError("Particle/initial shape needs exactly one of the keys stretch, map, file and run.");
  if (particle && !run)
    throw UserError("Particle/initial shape/particle needs Particle/initial shape/run, a run with the particle.");
  if (mode && !run)
    throw UserError("Particle/initial shape/mode needs Particle/initial shape/run, a run with a Spectrum that contains the mode.");
  if (map && !(map->determinant() > 0))
    throw UserError("Particle/initial shape/map must have a positive determinant, or the surface is turned inside out; it is " +
                    deck::number_text(map->determinant()) + ".");
}

std::optional<Mat3> InitialShape::affine(const Mat3& rotation) const {
  if (stretch) return Mat3(rotation * stretch->asDiagonal() * rotation.transpose());
  return map;
}

void ParticleShape::read() {
  if (shape == "file" && file) imported = std::make_shared<const spline::SplineSurface>(spline::read_iga(*file));
}

void ParticleShape::check() const {
  if (initial) initial->check();
  refuse(axis.has_value(), "Particle/axis", "Particle/shape `" + shape + "`", "it belongs to `cylinder`");
  refuse(shape != "file" && file, "Particle/file", "Particle/shape `" + shape + "`", "it belongs to `file`");
  if (shape == "file") {
    if (!file) throw UserError("Particle/shape `file` needs Particle/file, the path of a file in Bezier-extraction format (.iga).");
    refuse(radius || semi_axes, std::string("Particle/") + (radius ? "radius" : "semi-axes"), "Particle/shape `file`",
           "the file determines the size");
    return;
  }
  refuse(round() && semi_axes, "Particle/semi-axes", "Particle/shape `" + shape + "`", "give Particle/radius");
  refuse(!round() && radius, "Particle/radius", "Particle/shape `" + shape + "`", "give Particle/semi-axes");
  if (!round() && !semi_axes) throw UserError("Particle/shape `" + shape + "` needs Particle/semi-axes, three lengths.");
  if (shape == "spheroid") {
    const Vec3& a = *semi_axes;
    if (a[0] != a[1] && a[1] != a[2] && a[0] != a[2])
      throw UserError(
          "Particle/semi-axes of a `spheroid` must contain two equal lengths; for three different lengths give Particle/shape "
          "`ellipsoid`.");
  }
}

Mat3 ParticleShape::rotation() const {
  const Vec3 turn = orientation * (std::numbers::pi / 180.0);
  const double angle = turn.norm();
  if (angle == 0.0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

bool ParticleShape::sized() const {
  if (round()) return radius.has_value();
  return imported || (shape != "file" && semi_axes);
}

double ParticleShape::circumscribed_radius() const {
  double stretched = 1;
  if (const auto map = initial ? initial->affine(rotation()) : std::nullopt)
    stretched = map->jacobiSvd().singularValues()[0] / (initial->volume == "own" ? 1 : std::cbrt(map->determinant()));
  if (imported)
    return stretched * (imported->net.rowwise() - measures(imported->space, imported->net).centroid.transpose()).rowwise().norm().maxCoeff();
  return stretched * (radius ? *radius : semi_axes.value().maxCoeff());
}

double ParticleShape::equivalent_radius() const {
  if (shape == "sphere" || shape == "cylinder") return radius.value();
  if (shape == "red cell") {
    // Volume of a red cell divided by R^3: V = 2 pi R^3 int_0^1 r sqrt(1 - r^2) (c0 + c1 r^2 + c2 r^4) dr
    const auto [c0, c1, c2] = red_cell_profile;
    const double volume = 2.0 * std::numbers::pi * (c0 / 3.0 + c1 * 2.0 / 15.0 + c2 * 8.0 / 105.0);
    return radius.value() * std::cbrt(volume * 3.0 / (4.0 * std::numbers::pi));
  }
  if (imported) return std::cbrt(volume(imported->space, imported->net) * 3.0 / (4.0 * std::numbers::pi));
  return std::cbrt(semi_axes.value().prod());
}

std::optional<double> ParticleShape::exact_volume() const {
  const double resting = 4 * std::numbers::pi / 3 * std::pow(equivalent_radius(), 3);
  if (!initial || initial->volume != "own") return resting;
  const auto map = initial->affine(rotation());
  if (!map) return std::nullopt;
  return resting * std::abs(map->determinant());
}

}  // namespace tanktread::surface
