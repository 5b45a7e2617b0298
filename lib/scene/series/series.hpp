#pragma once
// The series of a run: columns of its progress, and which columns its rows have in which order.

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

/// Data of the progress of a run for one row.
struct ProgressRow {
  motion::StepReport step = {};  ///< that ended here
  double wall_seconds = 0;
  std::optional<long> evaluations = {};  ///< velocity evaluations of all systems of a branch; if not given, those of `work`
  double time = 0;
  coupling::Work work = {};
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Data of a branch point, a periodic motion and a spectrum for one row.
struct SteadyRow {
  motion::BranchPoint point;
  double period = 0;
  std::vector<motion::Mode> modes;
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Returns the columns of all rows of a run in their order, without values: of one of several particles `<particle>/<name>`.
Columns columns(const Scene& scene);

/// Returns the run's own part of them; with `every` for the manual (Columns).
Columns run_columns(const Scene& scene, bool every = false);

/// Returns the part of one particle of a system, without its name.
Columns particle_columns(const Scene& one, bool every = false);

/// Adds the columns of registered series: of a particle, or of the run.
void add_series(const Scene& scene, double time, const RecordedParticle& particle, Columns& to);
void add_series(const Scene& scene, double time, std::span<const RecordedParticle> particles, Columns& to);

/// Puts columns of the program into the order of the manual; columns of parts from outside follow as they were added.
void put_in_order(Columns& columns);

/// Puts the columns of a row into this order. Throws RunFailure as Columns::check.
void finish(Columns& row);

/// Markdown: series and fields of the results, entries of the summary and numbers of a scene, each with its unit.
std::string series_manual(const Registry& registry);

}  // namespace tanktread
