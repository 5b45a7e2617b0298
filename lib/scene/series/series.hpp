#pragma once
// Columns (time series) of the results of a run: the columns about its progress, and the order of all columns in a row.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "motion/continuation.hpp"
#include "motion/integrator.hpp"
#include "motion/spectrum.hpp"
#include "scene/scene.hpp"
#include "system/capsule.hpp"

namespace tanktread {

/// Data about the progress of a run, for one row of the results.
struct ProgressRow {
  motion::StepReport step = {};  ///< report of the time step that ended at this row
  double wall_seconds = 0;
  /// number of velocity evaluations in a search for steady shapes, summed over all systems (one per value of the continuation parameters); if not
  /// set, the number in `counts` is used
  std::optional<long> evaluations = {};
  double time = 0;
  coupling::OperationCounts counts = {};
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Data of a steady shape on a branch, of a periodic motion or of a spectrum, for one row of the results.
struct SteadyRow {
  motion::BranchPoint point;
  double period = 0;
  Vec3 mean_velocity = Vec3::Zero();  ///< mean velocity of the particles over the period
  std::vector<motion::Mode> modes;
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Returns the columns of a run's results, without values, in the order in which each row contains them. If there are several particles, the columns
/// of each particle are named `<particle>/<name>`.
Columns columns(const Scene& scene);

/// Returns the columns of the run as a whole. If `every`, also returns the columns that this scene does not have, for the manual (see Columns).
Columns run_columns(const Scene& scene, bool every = false);

/// Returns the columns of one particle of a system; their names do not contain the name of the particle. If `every`, also returns the columns that
/// this particle does not have, for the manual.
Columns particle_columns(const ParticleScene& particle_scene, bool every = false);

/// Adds the columns of user-defined series: the first function for one particle, the second for the whole run.
void add_series(const SharedOptions& shared, double time, const RecordedParticle& particle, Columns& to);
void add_series(const SharedOptions& shared, double time, std::span<const RecordedParticle> particles, Columns& to);

/// Sorts the columns in the order of the manual. Columns that this order does not contain follow in the order in which they were added.
void put_in_order(Columns& columns);

/// Sorts the columns of a row in the order of the manual and checks them. Throws RunFailure if the check fails (see Columns::check).
void finish(Columns& row);

}  // namespace tanktread
