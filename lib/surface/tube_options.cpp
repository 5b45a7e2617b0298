#include "surface/tube_options.hpp"

#include "base/errors.hpp"
#include "deck/section.hpp"

namespace tanktread::surface {

void TubeOptions::declare(deck::Section& list) {
  list.key(
      "section", section, deck::Choice{"circle", "ellipse", "rectangle", "file"},
      "cross-section of the tube, in the plane x2 x3: `circle` of `radius`, `ellipse` of `semi-axes`, `rectangle` of `sides`, all about "
      "the origin; `file`: any closed `outline`");
  if (section == "circle") radius = 1;
  list.key("radius", radius, deck::positive(), "length", "of the `circle`; 1 if not given");
  list.key("semi-axes", semi_axes, deck::positive(), "length", "two, along x2 and x3, of the `ellipse`");
  list.key("sides", sides, deck::positive(), "length", "two, along x2 and x3, of the `rectangle`");
  list.key("outline", outline, deck::Choice{},
           "file of the section `file`, looked for where the program is started and beside the deck: one point a row, x2,x3, "
           "counter-clockwise, the first not repeated; a third column holds the word `corner` where two smooth sides meet. A cubic spline "
           "goes through the points");
  list.key("length", length, deck::positive(), "length",
           "of the tube's piece that is modelled; if not given 2 pi R_T, R_T = sqrt(area of the section / pi), or the particle's length "
           "and 4.6 R_T where that is more");
  list.key("azimuthal elements", azimuthal_elements, deck::between(8, 400), "1", "of the wall, around");
  list.key("axial elements", axial_elements, deck::between(4, 400), "1", "of the wall, along");
  list.key("grading", grading, deck::between(1.0, 20.0), "1",
           "g: the wall's elements along the tube are denser around the particle, as 1 + (g - 1)/(1 + (x1/R_T)^4); 1: uniform");
  list.key("contact gap", contact_gap, deck::not_negative(), "R_C",
           "smallest gap between particle and wall; a run that comes closer stops with a checkpoint. Integrals keep their accuracy down to "
           "0.02");
  list.key("flow", flow, deck::Choice{"exact", "boundary elements"},
           "the duct's own flow: `exact`, in closed form or as a series where the section has one; `boundary elements` (P-33, P-34, P-35) "
           "otherwise, and on demand");
  list.key("flow elements", flow_elements, deck::between(8, 4000), "1", "boundary elements of the duct's own flow");
}

void TubeOptions::check() const {
  const auto belongs = [this](const char* key, bool given, const char* owner) {
    if (given && section != owner)
      throw UserError(std::string("Tube/") + key + " belongs to Tube/section `" + owner + "`, but Tube/section is `" + section + "`.");
    if (!given && section == owner) throw UserError(std::string("Tube/section `") + owner + "` needs Tube/" + key + ".");
  };
  belongs("radius", radius.has_value(), "circle");
  belongs("semi-axes", semi_axes.has_value(), "ellipse");
  belongs("sides", sides.has_value(), "rectangle");
  belongs("outline", outline.has_value(), "file");
}

}  // namespace tanktread::surface
