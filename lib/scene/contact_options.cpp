#include "base/errors.hpp"
#include "scene/scene.hpp"

namespace tanktread {

void ContactOptions::reject(const SharedOptions& shared, Rejections& to) const {
  to.pair(limiter && !shared.runs_in_time(), "Contact/limiter", shared.sought(), "it acts on steps of a run in time");
}

void ContactOptions::declare(deck::Section& section) {
  section.key("limit", limit, deck::between(1e-6, 1), "R_C",
              "smallest allowed gap between two particles, divided by R_C, the radius of the sphere with the volume of the smallest "
              "particle. If a gap becomes smaller, the run ends with a checkpoint, unless Contact/limiter is true");
  section.key("limiter", limiter,
              "if true, contact forces keep the gaps between particles at Contact/limit or above, to 2 % of it, and the run continues. They act "
              "along the normals at the nearest points of two particles, only push (4.23), and vanish while the fluid keeps the gaps "
              "open; the series `contact_force` and `contact_impulse` record them. Gaps to a wall are not limited");
  if (limiter && !section.given("limit"))
    throw UserError(section.path("limiter") + " needs " + section.path("limit") + ": the gap, divided by R_C, that it maintains.");
}

}  // namespace tanktread
