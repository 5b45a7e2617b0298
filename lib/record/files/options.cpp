#include "record/files/options.hpp"

#include <algorithm>
#include <chrono>

#include "base/errors.hpp"
#include "deck/section.hpp"

namespace tanktread::output {

void Options::declare(deck::Section& section) {
  section.key("interval", interval, deck::positive(), "time", "simulated time between snapshots; if not given, a twentieth of the final time");
  section.key("between steps", between_steps, deck::Choice{"land", "interpolate"},
              "treatment of snapshots whose times lie within a time step. `land`: the step is shortened to end at the snapshot time. "
              "`interpolate`: the step keeps its length, and the snapshot shows the cubic interpolant between the ends of the step; a "
              "run resumed from this snapshot starts at the end of the step. The default is `interpolate` with Time/fixed step, unless "
              "the mesh of the section Particle adapts, and otherwise `land`");
  section.key("wall-clock limit", wall_clock_limit, deck::positive(), "seconds",
              "real (wall-clock) time in seconds, from the start of the program, after which the run stops with a checkpoint, from which "
              "--resume continues it; no limit if not given. Steady, Periodic, Spectrum and Continuation cannot be resumed: of a branch, only "
              "the completed points are kept");
  section.key("power balance", power_balance,
              "whether the series contain the power input by flow and forces, the dissipation in the fluids (6.12), and the residual of "
              "the power balance, which measures the error of the velocities (6.13). Each row of the series then costs an evaluation of "
              "the boundary integrals at four points per element. Available for deformable particles, also together with rigid bodies, "
              "except for a flow of your own (C++) whose gradient is not uniform, and for `parabolic` flow in a Domain without two plates");
  section.key("view direction", view, deck::any(), "1",
              "direction in which each moving particle is seen: three numbers, whose common factor has no effect. The series then contain area and "
              "circularity of the particle's outline in this direction and of the convex hull of the outline: `projected_area`, `circularity`, "
              "`hull_area`, `hull_circularity`. No such series if not given");
  if (view && !(view->norm() > 0)) throw UserError("Output/view direction must have a direction, but is [0, 0, 0]: give, for example, [0, 1, 0].");
  section.key("surface text", surface_text,
              "whether the final surface is written in Bezier-extraction format to the file `surface.iga`. After a run of one particle, another "
              "deck can read this file by Particle/file");
}

void Options::limit(Phases::Clock::time_point start, std::optional<double> most) {
  const double past = std::chrono::duration<double>(Phases::Clock::now() - start).count();
  if (wall_clock_limit) wall_clock_limit = std::max(0., *wall_clock_limit - past);
  if (most) wall_clock_limit = std::min(*most, wall_clock_limit.value_or(*most));
}

}  // namespace tanktread::output
