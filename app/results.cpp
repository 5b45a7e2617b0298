#include "app/results.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "app/duct_picture.hpp"
#include "app/provenance.hpp"
#include "base/errors.hpp"
#include "deck/expectation.hpp"
#include "output/checkpoint.hpp"
#include "output/file.hpp"
#include "output/progress.hpp"
#include "output/snapshot.hpp"
#include "output/state.hpp"
#include "spline/iga.hpp"

namespace tanktread {

namespace {

/// The edges of the T-mesh; the lattice follows from the deck.
void store(const spline::TMesh& mesh, output::Checkpoint& checkpoint) {
  checkpoint.arrays["mesh edges"] = Eigen::Map<const Eigen::Matrix<std::uint8_t, Eigen::Dynamic, 1>>(
                                        mesh.edges.data(), static_cast<Eigen::Index>(mesh.edges.size())).cast<double>();
  checkpoint.arrays["mesh spacing"] =
      Eigen::Map<const Eigen::VectorXi>(mesh.spacing.data(), static_cast<Eigen::Index>(mesh.spacing.size())).cast<double>();
}

/// The body on the stored mesh; none where the checkpoint holds no mesh.
std::unique_ptr<Body> stored_body(const Scene& scene, const Body& first, const output::Checkpoint& checkpoint) {
  const auto edges = checkpoint.arrays.find("mesh edges");
  if (edges == checkpoint.arrays.end()) return {};
  auto body = std::make_unique<Body>(first);
  const Eigen::MatrixXd &spacing = checkpoint.arrays.at("mesh spacing"), &bits = edges->second;
  if (static_cast<size_t>(bits.size()) != body->mesh.edges.size())
    throw UserError("Adaptation/enabled and Adaptation/levels cannot change when a run goes on from a mesh that is refined.");
  spline::TMesh mesh = body->mesh;
  for (Eigen::Index i = 0; i < bits.size(); ++i) mesh.edges[static_cast<size_t>(i)] = static_cast<std::uint8_t>(bits(i));
  for (Eigen::Index i = 0; i < spacing.size(); ++i) mesh.spacing[static_cast<size_t>(i)] = static_cast<int>(spacing(i));
  lay_out(scene, std::move(mesh), *body);
  body->unstressed = checkpoint.arrays.at("unstressed");
  body->rest = checkpoint.arrays.at("initial");
  body->volume = checkpoint.numbers.at("initial volume");
  body->refit_error = checkpoint.numbers.at("refit error");
  return body;
}

Resumed stored_run(const Scene& scene, const Body& first, const output::Checkpoint& checkpoint, const std::filesystem::path& directory) try {
  return {output::stored_state(checkpoint), stored_standing(checkpoint), stored_body(scene, first, checkpoint)};
} catch (const std::out_of_range&) {
  throw UserError("--resume " + directory.string() + ": its newest checkpoint, written by another version, lacks what this one goes on from");
}

}  // namespace

output::Entries<double> with_earlier(const Phases& phases, const output::Entries<double>& earlier) {
  output::Entries<double> seconds;
  for (const Phases::Phase& phase : phases.all()) seconds.emplace_back(phase.name, phase.seconds);
  for (const auto& [name, before] : earlier) {
    const auto same = std::ranges::find(seconds, name, &std::pair<std::string, double>::first);
    if (same == seconds.end())
      seconds.emplace_back(name, before);
    else
      same->second += before;
  }
  return seconds;
}

std::string kept_outline(const Scene& scene) { return std::filesystem::path(scene.tube.outline.value()).filename(); }

/// Ranks act; if one fails, every rank throws: UserError for a mistake of the user's, RunFailure for anything else.
template <class Act>
void Results::together(bool acts, const Act& action) {
  std::string error;
  bool mistake = false;
  if (acts) {
    try {
      action();
    } catch (const std::exception& exception) {
      error = exception.what();
      mistake = dynamic_cast<const UserError*>(&exception) != nullptr;
    }
  }
  if (!ranks_.any(!error.empty())) return;
  if (error.empty()) error = "another rank could not write";
  if (ranks_.any(mistake)) throw UserError(error);
  throw RunFailure(error);
}

/// The first rank does.
template <class Write>
void Results::write(const Write& action) {
  together(writes_, action);
}

std::map<std::string, std::string> Results::origin() const {
  std::map<std::string, std::string> made_by = provenance();
  made_by["ranks"] = std::to_string(ranks_.size());
  return made_by;
}

Results::Results(const Scene& scene, const RunRequest& request, const Body& body, const surface::BezierMap& map,
                 const std::vector<Column>& columns, const coupling::Ranks& ranks)
    : scene_(scene), request_(request), body_(&body), columns_(columns), ranks_(ranks), writes_(ranks.rank() == 0), directory_(request.output) {
  write([&] {
    occupation_.emplace(directory_);
    request.resume ? output::tidy_directory(directory_) : begin();
  });
  remesh(body, map);
}

/// The files of a new run.
void Results::begin() {
  output::start_directory(directory_);
  if (scene_.tube.outline) keep(*scene_.tube.outline, kept_outline(scene_));
  if (scene_.particle.shape.imported) keep(*scene_.particle.shape.file, kept_surface);
  if (body_->duct) output::write_arrays(directory_ / "duct.h5", duct_picture(*body_->duct));
  record_.emplace(directory_ / "run.h5", request_.deck_text, origin());
  series_.emplace(directory_);
  declare_columns();
}

void Results::keep(const std::filesystem::path& file, const std::filesystem::path& name) {
  const std::filesystem::path place = directory_ / name;
  std::error_code absent;
  if (!std::filesystem::equivalent(file, place, absent))
    std::filesystem::copy_file(file, place, std::filesystem::copy_options::overwrite_existing);
}

void Results::declare_columns() {
  for (const Column& column : columns_) record_->declare(column.name, column.unit, column.description);
}

void Results::remesh(const Body& body, const surface::BezierMap& map) {
  body_ = &body;
  nodes_.emplace(map, output::lagrange_mesh(body.space, body.unstressed));
}

std::optional<Resumed> Results::resumed() {
  if (!request_.resume) return {};
  const auto saved = output::newest_checkpoint(directory_);  // every rank reads it: one file, read-only
  if (!saved) throw UserError("--resume " + directory_.string() + ": there is no checkpoint in this directory");
  for (const output::Snapshot& file : saved->damaged)
    warn(file.path.filename().string() + " is damaged: the run goes on from " + saved->file.path.filename().string());
  Resumed resumed = stored_run(scene_, *body_, saved->checkpoint, directory_);
  last_saved_ = resumed.standing.step;
  for (const Warning& warning : resumed.standing.warnings.said) warnings_.push_back(warning.sentence);
  write([&] {
    record_.emplace(output::RunRecord::load(directory_ / "run.h5"));
    record_->truncate(static_cast<size_t>(resumed.standing.step) + 1);
    record_->describe(request_.deck_text, origin());
    declare_columns();
    series_.emplace(output::SnapshotSeries::resumed(directory_, last_saved_));
  });
  return resumed;
}

void Results::record(const std::vector<double>& row) {
  write([&] { record_->append(row); });
}

void Results::warn(const std::string& sentence) {
  warnings_.push_back(sentence);
  if (writes_) std::fprintf(stderr, "tanktread: warning: %s\n", sentence.c_str());
}

void Results::write_surface(const Net& surface) {
  write([&] { spline::write_iga(directory_ / "surface.iga", body_->space, surface); });
}

void Results::save(const motion::State& state, const Standing& standing, const Portrait& portrait, double picture_time) {
  const std::filesystem::path path = directory_ / output::snapshot_name(standing.step);
  write_picture(path, portrait, state, standing, picture_time);
  write([&] {
    output::finish(path);
    series_->add(standing.step, picture_time);
  });
  last_saved_ = standing.step;
}

output::Checkpoint Results::checkpoint(const motion::State& state, const Standing& standing, double picture_time) const {
  output::Checkpoint checkpoint;
  output::store(state, checkpoint);
  store(standing, checkpoint);
  checkpoint.numbers["picture time"] = picture_time;
  checkpoint.arrays["unstressed"] = body_->unstressed;
  checkpoint.arrays["initial"] = body_->rest;
  checkpoint.texts["deck"] = request_.deck_text;
  checkpoint.numbers["initial volume"] = body_->volume;
  checkpoint.numbers["refit error"] = body_->refit_error;
  if (scene_.adaptation.enabled) store(body_->mesh, checkpoint);
  return checkpoint;
}

/// The first rank lays the file out, while others evaluate the fields at their nodes already; each fills in its own, piece by piece, and the last
/// one the cells.
void Results::write_picture(const std::filesystem::path& path, const Portrait& portrait, const motion::State& state, const Standing& standing,
                            double picture_time) {
  constexpr int most = 4096;  // shorter pieces take longer to write, longer ones wait for those of others
  const std::int64_t n = nodes_->all().size(), rank = ranks_.rank(), size = ranks_.size();
  const int end = static_cast<int>((rank + 1) * n / size);
  output::NodeRange piece{static_cast<int>(rank * n / size), 0};
  std::vector<output::Field> fields;
  const auto evaluate = [&](int length) {
    piece.end = std::min(piece.begin + length, end);
    fields = output::picture(*nodes_, portrait.surface, piece);
    for (output::Field& field : portrait.fields(*nodes_, piece)) fields.push_back(std::move(field));
  };
  evaluate(writes_ ? 0 : most);
  const output::Checkpoint saved = checkpoint(state, standing, picture_time);
  std::vector<std::int64_t> places(output::n_places(saved, fields));
  write([&] { places = output::lay_out_snapshot(path, saved, nodes_->mesh(), fields); });
  ranks_.first(places);
  together(true, [&] {
    output::SnapshotParts file(path, places);
    if (writes_) file.write(saved);
    if (rank == size - 1) file.write(nodes_->mesh());
    file.write(fields, piece);
    while (piece.end < end) {
      piece.begin = piece.end;
      evaluate(most);
      file.write(fields, piece);
    }
    file.close();
  });
}

int Results::close(const Account& account, const Phases& phases) {
  std::string missed;
  write([&] { missed = finish(account, phases); });
  if (!account.whole) missed.clear();
  if (writes_) {
    if (!request_.quiet) std::fputs(output::closing_table(phases, account.counts, directory_).c_str(), stdout);
    const std::string line = account.remark + (account.remark.empty() || missed.empty() ? "" : "; ") + missed;
    if (!line.empty()) std::fprintf(stderr, "tanktread: %s\n", line.c_str());
  }
  return ranks_.any(!missed.empty()) ? 1 : 0;
}

/// Writes the summary; returns what was expected and missed, in one line.
std::string Results::finish(const Account& account, const Phases& phases) {
  output::Summary summary;
  summary.status = account.status;
  deck::SeriesTable table;
  for (const output::Series& series : record_->series()) {
    table[series.name] = series.values;
    summary.final.emplace_back(series.name, series.values.back());
  }
  std::string missed;
  for (const deck::Verdict& verdict : deck::verdicts(scene_.expect.all, table)) {
    summary.expect.push_back({verdict.name, verdict.value, verdict.expected, verdict.error, verdict.passed});
    if (!verdict.passed) missed += (missed.empty() ? "missed Expect/" : "; Expect/") + verdict.name + ": " + verdict.reason;
  }
  for (const auto& [name, value] : account.vectors) summary.final_vectors.emplace_back(name, std::vector<double>(value.begin(), value.end()));
  summary.counts = account.counts;
  summary.seconds = with_earlier(phases, account.earlier);
  summary.plan = account.plan;
  summary.warnings = warnings_;
  output::write_summary(directory_ / "summary.yaml", summary);
  return missed;
}

}  // namespace tanktread
