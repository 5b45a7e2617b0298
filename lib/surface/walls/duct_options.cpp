#include "surface/walls/duct_options.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::surface {

DuctProperties properties(DuctKind kind) {
  switch (kind) {
    case DuctKind::straight_tube:
      return {.section = "Tube", .fixed = false, .parallel_flow = true, .uses_means = false, .may_iterate = false, .corrects_walls = false};
    case DuctKind::channel:
      return {.section = "Channel", .fixed = true, .parallel_flow = false, .uses_means = true, .may_iterate = true, .corrects_walls = true};
  }
  throw std::logic_error("unknown DuctKind");
}

void TubeOptions::declare(deck::Section& list) {
  list.key("section", section, duct_sections,
           "cross-section of the tube or channel in the plane x2 x3: `circle` of `radius`, `ellipse` of `semi-axes` or `rectangle` of "
           "`sides`, centred at the origin; `file`: any closed `outline`");
  if (section == "circle") radius = 1;
  list.key("radius", radius, deck::positive(), "length",
           "radius of the tube or channel if its cross-section is a `circle`; 1 if not given");
  list.key("semi-axes", semi_axes, deck::positive(), "length",
           "semi-axes along x2 and x3 of the cross-section of the tube or channel if it is an `ellipse`, two numbers");
  list.key("sides", sides, deck::positive(), "length",
           "side lengths along x2 and x3 of the cross-section of the tube or channel if it is a `rectangle`, two numbers");
  list.key("outline", outline,
           "path of a file with the closed outline of the cross-section, for `section` `file`: one row x2,x3 per point, in the deck's "
           "unit of length, counter-clockwise. A cubic spline passes through the points; where two sides meet at a corner, the row of "
           "the corner has the word `corner` in a third column. A first line may name the columns, in any order, and their units. The "
           "first point need not be repeated at the end. A relative "
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
             "number of elements along the wall of the tube, from end to end or over one period. If not given: 25 beside 24 `azimuthal "
             "elements` and otherwise in proportion, or in a periodic tube as many elements per length as these give in a tube with ends");
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
  list.key("points", points,
           "path of a file with the shape of the channel, for `profile` `file`: one row s,f per point, with the arc length s of the "
           "centre line in the deck's unit of length (ascending) and the factor f of the cross-section, or s,f2,f3 with factors in x2 "
           "and x3. A first line may name the columns, in any order, and their units. A cubic spline passes through the points; beyond "
           "them the section is constant. A relative path is looked up in the "
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
  constexpr double not_known = std::numeric_limits<double>::infinity();
  if (section == "circle") return radius.value_or(not_known);
  if (section == "ellipse") return semi_axes ? semi_axes->minCoeff() : not_known;
  if (section == "rectangle") return sides ? sides->minCoeff() / 2 : not_known;
  if (section == "file") return not_known;
  throw std::logic_error(list() + "/section " + section + " has no half width");
}

bool TubeOptions::exact_flow() const {
  if (section == "circle" || section == "ellipse" || section == "rectangle") return flow == "exact";
  if (section == "file") return false;
  throw std::logic_error("it is not known whether the flow for " + list() + "/section " + section + " has a formula");
}

void TubeOptions::check() const {
  const auto belongs = [this](const char* key, bool given, std::initializer_list<const char*> owners) {
    const std::string word = list() + "/section";
    const bool owned = std::ranges::find(owners, section) != owners.end();
    std::vector<std::string> quoted;
    for (const char* owner : owners) quoted.push_back(std::string("`") + owner + "`");
    if (given && !owned)
      throw UserError(list() + "/" + key + " belongs to " + word + " " + deck::alternatives(quoted) + ", but " + word + " is `" + section + "`.");
    if (!given && owned) throw UserError(word + " `" + section + "` needs " + list() + "/" + key + ".");
  };
  if (channel) channel->check();
  if (images && period == 0)
    throw UserError(list() + "/images belongs to a periodic tube, but neither " + list() + "/periodic length nor Domain is given.");
  belongs("radius", radius.has_value(), {"circle"});
  belongs("semi-axes", semi_axes.has_value(), {"ellipse"});
  belongs("sides", sides.has_value(), {"rectangle"});
  belongs("outline", outline.has_value(), {"file"});
  if (repulsion.has_value() != repulsion_range.has_value())
    throw UserError(list() + "/repulsion and " + list() + "/repulsion range belong together, but one of them is not given.");
  if (repulsion && (section != "circle" || (channel && (channel->bend_radius || channel->directions != "x2 x3"))))
    throw UserError(list() + "/repulsion is available in straight channels with circular cross-sections only.");
}

}  // namespace tanktread::surface
