#pragma once
// Steady shapes and their modes, in place of a run in time.

#include <vector>

#include "app/scene.hpp"
#include "app/simulation.hpp"
#include "base/columns.hpp"
#include "motion/continuation.hpp"
#include "motion/spectrum.hpp"

namespace tanktread {

/// Data of a branch point, a periodic motion and a spectrum for one row.
struct SteadyRow {
  motion::BranchPoint point;
  double period = 0;
  std::vector<motion::Mode> modes;
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Does what Spectrum asks for. One row and one snapshot. Exit code and errors as of `simulate`. Collective.
int find_steady(const Scene& scene, const RunRequest& request);

}  // namespace tanktread
