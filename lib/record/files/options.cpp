#include "record/files/options.hpp"

#include "deck/section.hpp"

namespace tanktread::output {

void Options::declare(deck::Section& section) {
  section.key("interval", interval, deck::positive(), "time", "simulated time between snapshots; if not given, a twentieth of the final time");
  section.key("between steps", between_steps, deck::Choice{"land", "interpolate"},
              "treatment of snapshots that are due between two time steps. `land`: steps are shortened so that a step ends at each "
              "snapshot time. `interpolate`: steps keep their length; a snapshot shows the cubic interpolant of positions and velocities "
              "at both ends of a step, and its `checkpoint` is the end of the step; default with Time/fixed step unless the mesh adapts");
  section.key("wall-clock limit", wall_clock_limit, deck::positive(), "seconds",
              "wall-clock time after which the run stops with a checkpoint; no limit if not given");
  section.key("power balance", power_balance,
              "whether each row of the series contains the power input by flow and forces, the dissipation in the fluids (6.12), and the "
              "residual of the power balance, which measures the error of the velocities (6.13). Each row costs an evaluation of the "
              "boundary integrals at four points per element. Available for deformable particles, also together with rigid bodies, in "
              "flows with a uniform gradient or in tubes");
  section.key("surface text", surface_text,
              "whether the final surface is written in Bezier-extraction format to the file `surface.iga`, which Particle/file reads");
}

}  // namespace tanktread::output
