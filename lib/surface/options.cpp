#include "surface/options.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <tuple>

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
    azimuthal_elements = 32, meridional_elements = 16, pole_axis = "x3", poles = "bezier transform";
  } else {
    elements_per_side = fits_tightly ? 8 : 6, extraordinary_points = "g1";
  }
  if (of_cylinder) azimuthal_elements = 24;
  section.key("elements per side", elements_per_side, deck::between(3, 200), "1",
              "number n of elements along each edge of the cube from which the surface mesh is made, which has 6n^2 elements. With 6, "
              "deformations of a rounded particle have errors of about 0.1 %; elements half as long have about a sixteenth of the error. If not "
              "given: 6, or 8 for a rigid particle in a tube or channel if R_C is more than 3/4 of the distance from the axis to the wall");
  section.key(
      "extraordinary points", extraordinary_points, deck::Choice{"g1", "catmull-clark"},
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
  section.key("poles", poles, deck::Choice{"bezier transform", "plain", "c1"},
              "treatment of the poles of the polar surface mesh. `bezier transform`: degenerate elements are replaced by regular ones, as "
              "by Maestre et al. (2017); the default. `plain`: degenerate elements are kept. `c1`: tangent planes are continuous at the "
              "poles, with (r - 1)m + 6 control points for m elements around the axis and r from pole to pole");
  if (poles == "bezier transform") pole_subdivisions = 2;
  section.key("pole subdivisions", pole_subdivisions, deck::between(0, 4), "1",
              "number of times that the elements at the poles of the polar surface mesh are halved in azimuth before the transform of "
              "Surface/poles `bezier transform`; 2 if not given");
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
  refuse(pole_subdivisions && poles != "bezier transform", "Surface/pole subdivisions", "Surface/poles `" + poles.value_or("c1") + "`",
         "it belongs to `bezier transform`");
}

spline::PolarMesh MeshOptions::polar_mesh() const {
  const auto rule = poles == "plain" ? spline::PoleRule::plain : poles == "c1" ? spline::PoleRule::c1 : spline::PoleRule::bezier_transform;
  return {azimuthal_elements.value(), meridional_elements.value(), rule, pole_subdivisions.value_or(0)};
}

double MeshOptions::n_points() const {
  if (!polar()) return 6.0 * *elements_per_side * *elements_per_side + 2;
  const double m = *azimuthal_elements, r = *meridional_elements;
  return poles == "c1" ? (r - 1) * m + 6 : (r + 1) * m + 2;
}

double MeshOptions::n_elements() const {
  if (!polar()) return 6.0 * *elements_per_side * *elements_per_side;
  return 1.0 * *azimuthal_elements * *meridional_elements;
}

void ParticleShape::declare(deck::Section& section) {
  section.key("shape", shape, deck::Choice{"sphere", "spheroid", "ellipsoid", "red cell", "cylinder", "file"},
              "resting shape of the particle. `sphere`: of Particle/radius. `spheroid`, `ellipsoid`: with Particle/semi-axes. `red cell`: "
              "the biconcave disc of Evans and Fung, with its axis along the body-fixed x3. `cylinder`: a post, which is a fixed circular "
              "cylinder along Particle/axis through the whole period of the Domain. `file`: the closed surface in Particle/file");
  section.key("file", file, deck::Choice{},
              "path of a file with the resting shape: a closed spline surface in Bezier-extraction format (.iga), with lengths in the "
              "deck's unit. The mesh of the file is the mesh of the run, and the section Surface must be left out. A relative path is "
              "looked up in the working directory, then in the directory of the deck");
  const bool round = shape == "sphere" || shape == "red cell" || shape == "cylinder";
  if (round) radius = 1.0;
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
              "path of the results of an earlier run of one particle on the same mesh; the last shape of that run becomes the initial shape, at "
              "the same position. The path names a results directory, whose newest checkpoint is read, or one of its snapshots; if the mesh of that "
              "run was refined, the refined mesh is used. Surfactant and other surface fields start as in a new run. A relative path is looked "
              "up in the working directory, then in the directory of the deck");
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
  const bool round = shape == "sphere" || shape == "red cell";
  refuse(axis.has_value(), "Particle/axis", "Particle/shape `" + shape + "`", "it belongs to `cylinder`");
  refuse(shape != "file" && file, "Particle/file", "Particle/shape `" + shape + "`", "it belongs to `file`");
  if (shape == "file") {
    if (!file) throw UserError("Particle/shape `file` needs Particle/file, the path of a file in Bezier-extraction format (.iga).");
    refuse(radius || semi_axes, std::string("Particle/") + (radius ? "radius" : "semi-axes"), "Particle/shape `file`",
           "the file determines the size");
    return;
  }
  refuse(round && semi_axes, "Particle/semi-axes", "Particle/shape `" + shape + "`", "give Particle/radius");
  refuse(!round && radius, "Particle/radius", "Particle/shape `" + shape + "`", "give Particle/semi-axes");
  if (!round && !semi_axes) throw UserError("Particle/shape `" + shape + "` needs Particle/semi-axes, three lengths.");
  if (shape == "spheroid") {
    const Vec3& a = *semi_axes;
    if (a[0] != a[1] && a[1] != a[2] && a[0] != a[2])
      throw UserError(
          "Particle/semi-axes of a `spheroid` must contain two equal lengths; for three different lengths give Particle/shape "
          "`ellipsoid`.");
  }
}

bool ParticleShape::same_rest(const ParticleShape& other) const {
  const auto rest = [](const ParticleShape& s) { return std::tie(s.shape, s.radius, s.semi_axes, s.file, s.center, s.orientation); };
  return rest(*this) == rest(other);
}

Mat3 ParticleShape::rotation() const {
  const Vec3 turn = orientation * (std::numbers::pi / 180.0);
  const double angle = turn.norm();
  if (angle == 0.0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

bool ParticleShape::sized() const {
  if (shape == "sphere" || shape == "red cell") return radius.has_value();
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

void TubeOptions::declare(deck::Section& list) {
  list.key("section", section, deck::Choice{"circle", "ellipse", "rectangle", "file"},
           "cross-section of the tube or channel in the plane x2 x3: `circle` of `radius`, `ellipse` of `semi-axes` or `rectangle` of "
           "`sides`, centred at the origin; `file`: any closed `outline`");
  if (section == "circle") radius = 1;
  list.key("radius", radius, deck::positive(), "length",
           "radius of the tube or channel if its cross-section is a `circle`; 1 if not given");
  list.key("semi-axes", semi_axes, deck::positive(), "length",
           "semi-axes along x2 and x3 of the cross-section of the tube or channel if it is an `ellipse`, two numbers");
  list.key("sides", sides, deck::positive(), "length",
           "side lengths along x2 and x3 of the cross-section of the tube or channel if it is a `rectangle`, two numbers");
  list.key("outline", outline, deck::Choice{},
           "path of a file with the closed outline of the cross-section, for `section` `file`: one row x2,x3 per point, in the deck's "
           "unit of length, counter-clockwise. A cubic spline passes through the points; where two sides meet at a corner, the row of "
           "the corner has the word `corner` in a third column. The first point need not be repeated at the end. A relative "
           "path is looked up in the working directory, then in the directory of the deck");
  list.key("azimuthal elements", azimuthal_elements, deck::between(8, 400), "1",
           "number of elements around the wall of the tube or channel. It is increased slightly if sides of equal length would otherwise "
           "have different numbers of elements");
  if (channel) {
    channel->declare(list);
  } else {
    list.key("length", length, deck::positive(), "length",
             "length of the computed part of the tube; if not given, 2 pi R_T, or the particle's length plus 4.6 R_T if that is more. R_T: "
             "radius of the circle with the area of the cross-section");
    list.key("periodic length", periodic_length, deck::positive(), "length",
             "period along x1 of the tube and of an infinite train of particles in it. It is the same as a Domain that is periodic along "
             "x1 with this length");
    list.key("images", images, deck::between(1, 100), "1", "obsolete key without effect: a periodic tube has all its images");
    list.key("axial elements", axial_elements, deck::between(4, 400), "1",
             "number of elements along the wall of the tube, from end to end or over one period. If not given: 25, or in a periodic tube "
             "as many elements per length as 25 give in a tube with ends");
    list.key(
        "grading", grading, deck::between(1.0, 20.0), "1",
        "ratio g of the density of wall elements next to the particles to the density far from them; 1: all elements are equally long. "
        "At the distance x1 along the tube the density is proportional to 1 + (g - 1)/(1 + (x1/W)^4), with W the larger of half the "
        "particles' length and R_T, the radius of the circle with the area of the cross-section");
  }
  list.key("contact gap", contact_gap, deck::not_negative(), "R_C",
           "smallest allowed gap between a particle and the wall of the tube or channel, divided by R_C, the radius of the sphere with the "
           "volume of the smallest particle. If a gap is smaller, the run ends with a checkpoint. Integrals keep their accuracy down to a "
           "gap of 0.02");
  list.key("repulsion", repulsion, deck::positive(), "force/length^2",
           "strength p of a force that pushes membranes away from the wall, so that the film of fluid between them stops thinning. The force "
           "per unstressed area is p exp(-g/d) at the gap g, with the decay length d = `repulsion range` (3.22); no repulsion if not given. "
           "Available only in straight ducts with circular cross-sections");
  list.key("repulsion range", repulsion_range, deck::positive(), "length",
           "decay length d of the force per area p exp(-g/d), with p = `repulsion`, by which the wall repels membranes at a gap g. The film "
           "that stays open is a few times d wide. Give both keys or none");
  list.key(
      "flow", flow, deck::Choice{"exact", "boundary elements"},
      "method of computing the flow in an empty straight duct of this cross-section. `exact`: by a formula or series if one exists for "
      "the cross-section, and otherwise as `boundary elements`. `boundary elements`: by a two-dimensional boundary element method");
  list.key("flow elements", flow_elements, deck::between(8, 4000), "1",
           "number of boundary elements along the outline of the cross-section from which the flow in the empty duct is computed if "
           "`flow` is `boundary elements`");
}

void ChannelOptions::declare(deck::Section& list) {
  list.key(
      "profile", profile, deck::Choice{"straight", "constriction", "expansion", "step", "file"},
      "shape of the channel along its centre line: factor f by which the cross-section is scaled at the arc length s of the centre line. "
      "`straight`: f = 1. `constriction`: f = 1 - d (1 + cos(pi s/w))/2 for |s| < w. `expansion`: f = 1 + d (1 + cos(pi s/w))/2 for |s| < w. "
      "`step`: f = 1 - d for |s| < w with rounded edges. Elsewhere f = 1. `file`: f from the file `points`. d: `depth`, w: `half length`");
  if (profile == "constriction") depth = 0.5;
  list.key("depth", depth, deck::any(), "1",
           "depth d of the `profile`: it scales the cross-section of the channel by 1 - d in the middle of a constriction or in a step (a "
           "negative d widens a step), and by 1 + d in the middle of an expansion. 0.5 for `constriction` if not given; required for "
           "`expansion` and `step`");
  list.key("half length", half_length, deck::positive(), "length",
           "half length w, along the centre line, of the constriction, expansion or step of the channel (required for these profiles)");
  list.key("corner radius", corner_radius, deck::positive(), "length",
           "radius of the rounded edges of the step of the channel (`profile` `step`)");
  list.key(
      "directions", directions, deck::Choice{"x2 x3", "x2", "x3"},
      "directions in which `profile` scales the cross-section of the channel: both, or only `x2` or `x3`, with a constant size in the "
      "other direction");
  list.key("points", points, deck::Choice{},
           "path of a file with the shape of the channel, for `profile` `file`: one row s,f per point, with the arc length s of the "
           "centre line in the deck's unit of length (ascending) and the factor f of the cross-section, or s,f2,f3 with factors in x2 "
           "and x3. A cubic spline passes through the points; beyond them the section is constant. A relative path is looked up in the "
           "working directory, then in the directory of the deck");
  list.key("bend radius", bend_radius, deck::positive(), "length",
           "radius of the circular arc along which the centre line of the channel bends; straight if not given");
  list.key("bend start", bend_start, deck::any(), "length",
           "arc length s of the centre line of the channel at which its bend begins. Up to there, the centre line is the x1 axis and s = x1");
  list.key("bend angle", bend_angle, deck::between(0.01, 180.), "degrees",
           "angle, in degrees, by which the centre line of the channel turns in its bend, from x1 towards x2");
  list.key("start", start, deck::any(), "length",
           "arc length s of the centre line (s = x1 up to a bend) at which the computed part of the channel begins; if not given, 4 R_T "
           "before the first change of cross-section or direction. R_T: radius of the circle with the area of the inlet");
  list.key("end", end, deck::any(), "length",
           "arc length s of the centre line (s = x1 up to a bend) at which the computed part of the channel ends; if not given, 4 R_T "
           "after the last change of cross-section or direction. R_T: radius of the circle with the area of the inlet");
  list.key("axial elements", axial_elements, deck::between(8, 1000), "1",
           "number of elements along the wall of the channel. They are shorter where the channel is narrow, bends or has an edge. If not "
           "given, chosen such that elements are about as long as wide");
}

void ChannelOptions::check() const {
  const auto belongs = [this](const char* key, bool given, std::initializer_list<const char*> owners) {
    const bool owned = std::ranges::find(owners, profile) != owners.end();
    refuse(given && !owned, std::string("Channel/") + key, "Channel/profile `" + profile + "`", "this profile does not use the key");
    if (!given && owned) throw UserError("Channel/profile `" + profile + "` needs Channel/" + key + ".");
  };
  belongs("depth", depth.has_value(), {"constriction", "expansion", "step"});
  belongs("half length", half_length.has_value(), {"constriction", "expansion", "step"});
  belongs("corner radius", corner_radius.has_value(), {"step"});
  belongs("points", points.has_value(), {"file"});
  const std::string between = profile == "expansion" ? "between 0 and 20" : profile == "step" ? "between -20 and 1, and not 0" : "between 0 and 1";
  if (depth && !((profile == "expansion" ? *depth < 20 : *depth < 1) && (profile == "step" ? *depth > -20 && *depth != 0 : *depth > 0)))
    throw UserError("Channel/depth must be " + between + " for Channel/profile `" + profile + "`, but is " + deck::number_text(*depth) + ".");
}

double TubeOptions::half_width() const {
  if (radius) return *radius;
  if (semi_axes) return semi_axes->minCoeff();
  return sides ? sides->minCoeff() / 2 : std::numeric_limits<double>::infinity();
}

void TubeOptions::check() const {
  const auto belongs = [this](const char* key, bool given, const char* owner) {
    const std::string word = list() + "/section";
    if (given && section != owner)
      throw UserError(list() + "/" + key + " belongs to " + word + " `" + owner + "`, but " + word + " is `" + section + "`.");
    if (!given && section == owner) throw UserError(word + " `" + owner + "` needs " + list() + "/" + key + ".");
  };
  if (channel) channel->check();
  if (images && period == 0)
    throw UserError(list() + "/images belongs to a periodic tube, but neither " + list() + "/periodic length nor Domain is given.");
  belongs("radius", radius.has_value(), "circle");
  belongs("semi-axes", semi_axes.has_value(), "ellipse");
  belongs("sides", sides.has_value(), "rectangle");
  belongs("outline", outline.has_value(), "file");
  if (repulsion.has_value() != repulsion_range.has_value())
    throw UserError(list() + "/repulsion and " + list() + "/repulsion range belong together, but one of them is not given.");
  if (repulsion && (section != "circle" || (channel && (channel->bend_radius || channel->directions != "x2 x3"))))
    throw UserError(list() + "/repulsion is available in straight channels with circular cross-sections only.");
}

}  // namespace tanktread::surface
