#pragma once
// Everything that a run writes, and how a run finds its way back from it.

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "motion/integrator.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "record/files/nodes.hpp"
#include "record/files/run_record.hpp"
#include "record/files/snapshot.hpp"
#include "scene/body.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// What the command line says beside the deck.
struct RunRequest {
  std::string output;           ///< directory of the results
  bool resume = false;          ///< go on from the newest checkpoint there
  bool overwrite = false;       ///< delete the results of an earlier run there
  bool another_scheme = false;  ///< than the checkpoint's, of whose memory only shape, slope and step mean something to it
  bool quiet = false;           ///< no progress bar
  std::string deck_text;        ///< the effective deck, to be stored with the results
  std::map<std::string, std::string> provenance;  ///< of the program: version, git_commit, compiler
};

/// What a run keeps in its directory of the files that its deck names, for it goes on without them.
constexpr const char* kept_flow_history = "flow_history.csv";
std::string kept_surface(const ParticleKind& kind);  ///< of a particle's file
std::string kept_stress_free(const ParticleKind& kind);  ///< of its membrane's stress-free shape
std::string kept_places(const ParticleKind& kind);   ///< of its copies
std::string kept_name(const std::string& file);      ///< of an outline or of the points of a channel: without its folder

/// What a run says of itself when it ends.
struct Account {
  output::Entries<std::string> plan;
  output::Entries<long> counts;
  std::string status = "done";  ///< or `steady`, `stopped: ...`, `failed: ...`, as summary.yaml has it
  std::string remark;           ///< why it ended before its time, if it did; shares the one line on standard error with the expectations missed
  bool whole = true;            ///< it came to its end, so that expectations bind
  output::Entries<double> earlier;  ///< seconds of earlier parts of a resumed run
  output::Entries<Vec3> vectors;    ///< for `final`, made of the last row
  output::Entries<std::string> modes;  ///< of a spectrum
};

/// Seconds by phase, those of earlier parts of the run included.
output::Entries<double> with_earlier(const Phases& phases, const output::Entries<double>& earlier);

/// The newest sound checkpoint of a directory: the first rank finds it, and every rank reads the one that it names. Throws UserError when there is
/// none, RunFailure when one cannot be read. Collective.
output::Saved newest_checkpoint(const std::filesystem::path& directory, const coupling::Ranks& ranks);

/// The effective deck that the newest checkpoint of a directory holds. Throws as newest_checkpoint does. Collective.
std::string stored_deck(const std::string& directory);

/// Throws UserError where the directory holds results that the request does not allow to delete, or another run writes to it. Collective.
void check_vacant(const RunRequest& request);

/// The files of a run (README.md, Results). The first rank evaluates pictures and writes all files; every call is made
/// by all ranks, and all of them throw: RunFailure when the disk refuses, UserError where a run cannot begin in its directory.
///
/// From the first second of a run on, a snapshot and the record up to it are on the disk itself before `run.hdf.series` names the snapshot, and all
/// that a run has written is when it ends. In the first second the file is not written.
class Results {
 public:
  Results(const Scene& scene, const RunRequest& request, const Body& body, const surface::BezierMap& map, const coupling::Ranks& ranks);

  /// The newest checkpoint of the directory when the run is resumed; the record is cut back to it. Throws UserError when there is none.
  std::optional<Resumed> resumed();

  /// The body that is drawn from now on, and its extraction.
  void remesh(const Body& body, const surface::BezierMap& map);

  /// One finished step: a row of the record, which is written at every snapshot and otherwise once a second, or, where that takes long, after fifty
  /// times as much. Sets the row to the first rank's numbers on every rank: what is decided by it is decided alike.
  void record(Columns& row);

  /// A sentence about what the run has come near to, on standard error and in the summary.
  void warn(const std::string& sentence);

  /// Fields of a picture at the nodes of the present mesh, on the first rank. They can be written after the mesh has changed.
  struct Sampled {
    double time = 0;
    output::LagrangeMesh mesh;
    std::vector<output::Field> fields;
  };
  Sampled sample(const SurfacePicture& picture, double time);

  /// Checkpoint of the present step and a picture, of the same moment or of one within the step. `checkpoint` holds what else the run goes on from.
  void save(output::Checkpoint checkpoint, const motion::State& state, const RunTotals& totals, const Sampled& picture);

  /// The surface as Bezier-extraction text, `surface.iga`.
  void write_surface(const Net& surface);

  /// Holds the record against `Expect`, writes the summary and the closing table. Returns the exit code: 0 every expectation was met, or the run did
  /// not come to its end; 1 one was missed.
  int close(const Account& account, const Phases& phases);

  /// Step of the last checkpoint; -1 before the first.
  int last_saved() const { return last_saved_; }
  const std::filesystem::path& directory() const { return directory_; }

 private:
  template <class Write>
  void write(const Write& action);
  void begin();
  void keep(const std::filesystem::path& file, const std::filesystem::path& name);
  void declare_series();
  void complete(output::Checkpoint& checkpoint, const motion::State& state, const RunTotals& totals, double picture_time) const;
  void set_aside(const std::vector<output::Damaged>& damaged, const std::string& chosen);
  void load_record(const output::Checkpoint& checkpoint, const std::string& chosen);
  void write_record();
  output::Durable durable() const;
  std::string finish(const Account& account, const Phases& phases);
  std::map<std::string, std::string> origin() const;

  const Scene& scene_;
  const RunRequest& request_;
  const Body* body_;
  const coupling::Ranks& ranks_;
  const Columns columns_;  // of every row
  bool writes_;
  std::string run_;  // its identifier
  std::filesystem::path directory_;
  std::optional<output::Occupation> occupation_;
  std::optional<output::RunRecord> record_;
  std::optional<output::SnapshotSeries> series_;
  std::optional<output::Nodes> nodes_;  // of the pictures
  std::vector<std::string> warnings_;
  output::Entries<long> memory_;  // of the summary
  int last_saved_ = -1;
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now(), due_ = start_;  // the latter: when the record is to be written
};

/// What of `Expect` is missed whatever the run finds: a sentence for each time that it does not reach. Throws UserError where a series is expected
/// that the scene does not record.
std::vector<std::string> check_expectations(const Scene& scene);

}  // namespace tanktread
