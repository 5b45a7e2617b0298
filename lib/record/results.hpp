#pragma once
// Results of a run: all files that it writes, and their use when it is resumed.

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "motion/integrator.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/exit_code.hpp"
#include "record/files/file.hpp"
#include "record/files/nodes.hpp"
#include "record/files/run_record.hpp"
#include "record/files/snapshot.hpp"
#include "record/files/summary.hpp"
#include "scene/body.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Returns the peak memory in bytes: the largest of a rank, and the sum of all ranks. Collective.
output::Entries<long> peak_memory(const coupling::Ranks& ranks);

/// Options of the command line, and the deck.
struct RunRequest {
  std::string output;           ///< directory of the results
  bool resume = false;          ///< true to resume from the newest checkpoint in the directory
  bool overwrite = false;       ///< true to delete the results of an earlier run in the directory first
  bool another_scheme = false;  ///< true if the checkpoint has another time scheme; only the data that all schemes use are then kept
  bool quiet = false;           ///< true to show no progress bar
  /// true for a level of an accuracy ladder. The run then does not print its warnings, why it ended and how to resume it. The ladder does so, and
  /// prints only the warnings of its finest level.
  bool of_ladder = false;
  std::string deck_text;        ///< the effective deck, to be stored with the results
  /// Returns the scene of this deck with some keys changed by `settings`, each of which is `Section/key=value`.
  std::function<Scene(const std::vector<std::string>& settings)> changed;
  std::map<std::string, std::string> provenance;  ///< data of the program: version, git_commit, compiler
};

/// Data of a finished run for its summary and its messages.
struct Account {
  /// status, plan, counts, final_vectors and modes; Results::close() sets all other entries. A missed value of Expect fails the run only if the run
  /// has reached its end (output::reached_end)
  output::Summary summary = {};
  std::string remark = {};  ///< why the run ended early, if it did; printed on standard error together with missed expected values
  output::Entries<double> earlier = {};  ///< seconds by phase of earlier parts of a resumed run
};

/// Returns the seconds by phase, to which the seconds `earlier` of earlier parts of a resumed run are added.
output::Entries<double> with_earlier(const Phases& phases, const output::Entries<double>& earlier);

/// Returns the newest undamaged checkpoint of a directory. The first rank finds it, and every other rank reads the same file. Throws UserError if
/// there is no checkpoint, RunFailure if a checkpoint cannot be read. Collective.
output::Saved newest_checkpoint(const std::filesystem::path& directory, const coupling::Ranks& ranks);

/// Returns the effective deck from the newest checkpoint of a directory. Throws like newest_checkpoint. Collective.
std::string stored_deck(const std::string& directory);

/// Throws UserError if the directory holds results that the request does not allow to delete, or if another run writes to it. This early check spares
/// the set-up of a run that cannot write. The constructor of Results checks again when the directory is locked; that check decides. Collective.
void check_vacant(const RunRequest& request);

/// Files of a run (inputs/manual/results/index.md). The first rank samples snapshots and writes all files. Every call is collective, and all ranks
/// throw together: RunFailure if writing fails, UserError if a run cannot begin in its directory.
///
/// During the first second of a run, files are not flushed to the disk, and snapshots after the first one wait in memory until `run.h5` is written
/// next: repeating the last steps after a kill takes less time than writing `run.h5` for each snapshot. Afterwards, each snapshot and the rows of
/// `run.h5` up to its step are flushed before the snapshot is added to `run.hdf.series`. At the end of a run that lasted longer than a second, all
/// its results and the copies of files that the deck names are flushed. `run.hdf.series` is written for the first time after a second, or at the end
/// of the run.
///
/// Order of calls: resumed() if the run continues another one, then record() and save() for each recorded state, and close() last. lib/README.md
/// (files of `record`) has the order of all calls, also after a failure.
class Results {
 public:
  Results(const Scene& scene, const RunRequest& request, const Body& body, const surface::BezierMap& map, const coupling::Ranks& ranks);

  /// Returns the newest checkpoint of the directory if the run is resumed, otherwise nothing. Removes the rows of `run.h5` after this checkpoint.
  /// Throws UserError if there is no checkpoint.
  std::optional<Resumed> resumed();

  /// Sets the body to which later snapshots refer, and its Bezier extraction.
  void remesh(const Body& body, const surface::BezierMap& map);

  /// Adds the row of a finished step to `run.h5`. The file is written before every snapshot. Between snapshots, it is written again when the duration
  /// of the run has doubled or has grown by one second since the last write, but not before fifty times the duration of that write have passed. Sets
  /// the row on every rank to the values of the first rank, so that all ranks take the same decisions.
  void record(Columns& row);

  /// Prints a warning on standard error and adds it to the summary. A Warning has a kind. Pass it if errors may not be estimated because of the
  /// warning (accuracy::obstacle_of), or if the condition can recur: call Warnings::fresh() first, which admits each kind once, also in a run that is
  /// resumed. A sentence has no kind. Pass it if the condition occurs once.
  void warn(const std::string& sentence);
  void warn(const Warning& warning);

  /// Fields of a snapshot, sampled at the nodes of the current mesh, on the first rank. They can be written to a file even after the mesh has
  /// changed.
  struct Sampled {
    double time = 0;
    output::LagrangeMesh mesh;
    std::vector<output::Field> fields;
  };
  Sampled sample(const SurfaceSnapshot& snapshot, double time);

  /// Saves a checkpoint of the current step, and `snapshot`, which belongs to the end of the step or to a time within it. `checkpoint`:
  /// data for a resumed run. `state` and `totals` are added to these data.
  void save(output::Checkpoint checkpoint, const motion::TimeState& state, const RunTotals& totals, const Sampled& snapshot);

  /// Writes the surface as Bezier-extraction text, `surface.iga`.
  void write_surface(const Net& surface);

  /// Compares the series with `Expect`, writes the summary, and prints the closing table. Returns the exit code: Exit::missed if an expectation was
  /// missed and the run reached its end, otherwise Exit::done.
  int close(const Account& account, const Phases& phases);

  /// Returns the step of the last checkpoint, or -1 if no checkpoint has been saved yet.
  int last_saved() const { return last_saved_; }
  const std::filesystem::path& directory() const { return directory_; }

 private:
  using Clock = std::chrono::steady_clock;
  void begin();
  void keep(const std::filesystem::path& file, const std::filesystem::path& name);
  void declare_series();
  void complete(output::Checkpoint& checkpoint, const motion::TimeState& state, const RunTotals& totals, double picture_time) const;
  void set_aside(const std::vector<output::Damaged>& damaged, const std::string& chosen);
  Resumed read_run();
  void add_obstacle(const std::string& kind);
  void write_files();
  bool young() const { return Clock::now() - process_start_ < std::chrono::seconds(1); }
  output::Durable durable() const { return young() ? output::Durable::no : output::Durable::yes; }
  std::string finish(const Account& account, const Phases& phases);
  output::Entries<std::string> known_errors() const;
  std::map<std::string, std::string> origin() const;

  const Scene& scene_;
  const RunRequest& request_;
  const Body* body_;
  const coupling::Ranks& ranks_;
  const Columns columns_;  // columns of every row
  bool writes_;
  std::string run_;  // identifier of the run
  std::filesystem::path directory_;
  std::optional<output::Occupation> occupation_;
  std::optional<output::RunRecord> record_;
  std::size_t rows_written_ = 0;  // rows that this process has written to `run.h5`; 0 while it writes them, so that a failed write is repeated
  std::optional<output::SnapshotSeries> snapshots_;
  std::optional<output::Nodes> nodes_;  // nodes of the snapshots
  std::vector<std::pair<int, std::string>> unwritten_snapshots_;  // snapshots that are not written yet: step number and contents of the file
  std::vector<std::string> warnings_, obstacles_;
  output::Entries<long> memory_;  // peak memory, for the summary
  int last_saved_ = -1;
  Clock::time_point process_start_ = Clock::now(), due_ = process_start_;  // due_: time at which `run.h5` is to be written next
};

/// Returns the names of the series that a run of this scene records.
std::vector<std::string> names_of_series(const Scene& scene);

/// Returns the conditions under which series of this scene are NaN.
deck::UndefinedSeries undefined_series(const Scene& scene);

/// Returns a sentence for each expectation that the run cannot meet because it ends before the time of the expectation. Throws UserError if an
/// expected series is not recorded in this scene.
std::vector<std::string> check_expectations(const Scene& scene);

}  // namespace tanktread
