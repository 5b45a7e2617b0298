#pragma once
// Everything that a run writes, and how a run finds its way back from it.

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/body.hpp"
#include "app/diagnostics.hpp"
#include "motion/integrator.hpp"
#include "output/lagrange.hpp"
#include "output/run_record.hpp"
#include "output/snapshot_series.hpp"
#include "app/scene.hpp"
#include "app/simulation.hpp"

namespace tanktread {

/// Where a run stands beside its State.
struct Standing {
  int step = 0;               ///< steps so far; `run.h5` holds step + 1 rows
  double wall_seconds = 0;    ///< of earlier parts
  coupling::Work work;
  int refinements = 0, coarsenings = 0;
};

/// A run to go on with. The body is there when its mesh had been adapted.
struct Resumed {
  motion::State state;
  Standing standing;
  std::unique_ptr<Body> body;
};

/// The files of a run (README.md, Results). Only the first rank writes; every call is made by all ranks, and all of them throw
/// RunFailure when the disk refuses.
class Results {
 public:
  Results(const Scene& scene, const RunRequest& request, const Body& body, const coupling::Ranks& ranks);

  /// The newest checkpoint of the directory when the run is resumed; the record is cut back to it. Throws UserError when there is none.
  std::optional<Resumed> resumed();

  /// The body that is drawn from now on.
  void remesh(const Body& body);

  /// One finished step: a row of the record, written at once.
  void record(const std::vector<double>& row);

  /// Checkpoint and picture of the present step. `load`: control values of the load on the membrane.
  void save(const motion::State& state, const Standing& standing, const Net& load, const membrane::Membrane& membrane);

  /// Holds the record against `Expect` and writes the summary. Returns whether every expectation was met.
  bool finish(const output::Entries<std::string>& plan, const output::Entries<long>& counts, const Phases& phases);

  /// Step of the last checkpoint; -1 before the first.
  int last_saved() const { return last_saved_; }
  const std::filesystem::path& directory() const { return directory_; }

 private:
  template <class Write>
  void write(const Write& action);
  void write_snapshot(const motion::State& state, const Standing& standing, const Net& load, const membrane::Membrane& membrane);
  std::map<std::string, std::string> origin() const;

  const Scene& scene_;
  const RunRequest& request_;
  const Body* body_;
  const coupling::Ranks& ranks_;
  bool writes_;
  std::filesystem::path directory_;
  std::optional<output::RunRecord> record_;
  std::optional<output::SnapshotSeries> series_;
  output::LagrangeMesh picture_mesh_;
  int last_saved_ = -1;
};

}  // namespace tanktread
