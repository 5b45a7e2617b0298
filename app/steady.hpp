#pragma once
// Steady shapes and their modes, in place of a run in time.

#include <vector>

#include "app/scene.hpp"
#include "app/simulation.hpp"
#include "base/columns.hpp"
#include "motion/continuation.hpp"
#include "motion/spectrum.hpp"

namespace tanktread {

/// What a row holds of a point of a branch, of a periodic motion and of a spectrum.
struct SteadyRow {
  motion::BranchPoint point;
  double period = 0;
  std::vector<motion::Mode> modes;
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Does what Spectrum asks for. One row and one snapshot. Exit code and errors as of `simulate`. Collective.
int find_steady(const Scene& scene, const RunRequest& request);

}  // namespace tanktread
