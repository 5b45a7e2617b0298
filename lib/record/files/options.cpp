#include "record/files/options.hpp"

#include "deck/section.hpp"

namespace tanktread::output {

void Options::declare(deck::Section& section) {
  section.key("interval", interval, deck::positive(), "time",
              "simulated time between snapshots; if not given, a twentieth of the final time");
  section.key("between steps", between_steps, deck::Choice{"land", "interpolate"},
              "`land`: steps are shortened so that one ends at each snapshot; `interpolate`: steps keep their length, and pictures are of the cubic "
              "through places and velocities at both ends of a step (`checkpoint` is its end); the default with Time/fixed step");
  section.key("wall-clock limit", wall_clock_limit, deck::positive(), "seconds",
              "the run stops with a checkpoint after this time; if not given, never");
  section.key("power balance", power_balance,
              "whether each row holds what flow and forces put in, what the fluids dissipate (6.12), and what the velocities lack of it (6.13), at "
              "the price of the layers at four places an element a row; of what deforms, and rigid bodies among it, in flows of one gradient, in "
              "tubes");
  section.key("surface text", surface_text, "write the last surface as Bezier-extraction text, `surface.iga`, which Particle/file reads");
}

}  // namespace tanktread::output
