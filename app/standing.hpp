#pragma once
// Where a run stands beside its state, and how a checkpoint keeps it.

#include "app/turning.hpp"
#include "app/warnings.hpp"
#include "coupling/capsule.hpp"
#include "output/checkpoint.hpp"
#include "output/summary.hpp"
#include "stokes/kernels.hpp"

namespace tanktread {

/// What a run has done since its beginning, earlier parts of a resumed one included.
struct Standing {
  int step = 0;  ///< steps so far; `run.h5` holds step + 1 rows
  double wall_seconds = 0;
  coupling::Work work;
  int refinements = 0, coarsenings = 0;
  stokes::Evaluations kernel;       ///< of all ranks
  Warnings::Memory warnings;
  std::vector<Turning> turning;     ///< of each particle
  output::Entries<double> seconds;  ///< of the first rank, by phase
};

/// Adds all of `standing` to the checkpoint.
void store(const Standing& standing, output::Checkpoint& checkpoint);

/// The same. Throws std::out_of_range where the checkpoint lacks a part of it.
Standing stored_standing(const output::Checkpoint& checkpoint);

}  // namespace tanktread
