#include "record/results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <random>
#include <stdexcept>
#include <utility>

#include <sys/resource.h>

#include "accuracy/obstacles.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/threads.hpp"
#include "deck/expectation.hpp"
#include "deck/units.hpp"
#include "record/duct_arrays.hpp"
#include "record/files/file.hpp"
#include "record/files/progress.hpp"
#include "record/files/checkpoint.hpp"
#include "record/numbers.hpp"
#include "scene/series/series.hpp"
#include "spline/iga.hpp"
#include "system/parallel/agreement.hpp"

namespace tanktread {

namespace {

/// Returns a new, practically unique identifier of a run: sixteen hexadecimal digits.
std::string identifier() {
  std::random_device random;
  output::Checksum sum;
  for (int k = 0; k < 4; ++k) sum.add(static_cast<std::uint64_t>(random()));
  sum.add(static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count()));
  return sum.digits();
}

/// Returns the result of `act`, which reads a checkpoint. If act() finds that the run cannot be continued, adds to its UserError what can be done.
template <class Act>
auto resuming(const std::filesystem::path& directory, const Act& act) {
  const auto refuse = [&](const std::string& why) {
    return UserError("--resume " + directory.string() + ": " + why + "; run the deck again with --output " + directory.string() +
                     " --overwrite");
  };
  try {
    return act();
  } catch (const UserError& error) {
    throw refuse(error.what());
  } catch (const std::out_of_range&) {
    throw refuse(output::another_version);
  }
}

}  // namespace

output::Entries<long> peak_memory(const coupling::Ranks& ranks) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::vector<double> all(static_cast<std::size_t>(ranks.size()), 0);
  all[static_cast<std::size_t>(ranks.rank())] = 1024. * static_cast<double>(usage.ru_maxrss);
  ranks.add(all);
  return {{"largest of a rank", std::lround(std::ranges::max(all))}, {"all ranks", std::lround(std::accumulate(all.begin(), all.end(), 0.))}};
}

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

output::Saved newest_checkpoint(const std::filesystem::path& directory, const coupling::Ranks& ranks) {
  const bool chooses = ranks.rank() == 0;
  std::optional<output::Saved> saved;
  coupling::together(chooses, [&] { saved = output::newest_checkpoint(directory); });
  const auto step = static_cast<int>(coupling::of_first(saved ? static_cast<double>(saved->file.step) : -1.));
  if (step < 0) throw UserError("there is no checkpoint in this directory");
  coupling::together(!chooses, [&] {
    const std::filesystem::path path = directory / output::snapshot_name(step);
    saved = {{path, step}, output::read_checkpoint(path), {}};
  });
  return *saved;
}

void check_vacant(const RunRequest& request) {
  const coupling::Ranks ranks;
  std::error_code absent;
  coupling::together(ranks.rank() == 0 && !request.resume && !request.overwrite && std::filesystem::is_directory(request.output, absent), [&] {
    const output::Occupation occupation(request.output);
    output::check_vacant(request.output);
  });
}

std::map<std::string, std::string> Results::origin() const {
  std::map<std::string, std::string> made_by = request_.provenance;
  made_by["ranks"] = std::to_string(ranks_.size());
  made_by["threads"] = std::to_string(n_threads());
  made_by["run"] = run_;
  return made_by;
}

Results::Results(const Scene& scene, const RunRequest& request, const Body& body, const surface::BezierMap& map,
                 const coupling::Ranks& ranks)
    : scene_(scene), request_(request), body_(&body), ranks_(ranks), columns_(columns(scene)), writes_(ranks.rank() == 0),
      directory_(request.output) {
  std::vector<output::Array> channel;
  if (const auto* flow = dynamic_cast<const coupling::ChannelFlow*>(body.duct.get()); flow && !request.resume) channel = channel_arrays(*flow);
  coupling::together(writes_, [&] {
    occupation_.emplace(directory_);
    request.resume ? output::tidy_directory(directory_) : begin();
    if (!channel.empty()) output::write_arrays(directory_ / output::channel_file, channel);
  });
  remesh(body, map);
}

/// Creates the files of a new run.
void Results::begin() {
  if (!request_.overwrite) output::check_vacant(directory_);
  for (const auto& [file, name] : scene_.files) keep(file, name);  // first, because it may be a result of the run that is overwritten
  output::start_directory(directory_);
  run_ = identifier();
  // A ChannelFlow is copied as its base, the flow in the straight duct at its inlet.
  if (body_->duct) output::write_arrays(directory_ / output::duct_file, duct_arrays(stokes::DuctFlow(*body_->duct)));
  record_.emplace(directory_ / output::record_file, request_.deck_text, origin());
  snapshots_.emplace(directory_);
  declare_series();
}

void Results::keep(const std::filesystem::path& file, const std::filesystem::path& name) {
  const std::filesystem::path place = directory_ / name;
  std::error_code error;
  if (std::filesystem::equivalent(file, place, error)) return;
  const std::filesystem::path part = place.string() + ".part";  // so that a run that is killed here leaves no incomplete copy
  if (std::filesystem::copy_file(file, part, std::filesystem::copy_options::overwrite_existing, error)) std::filesystem::rename(part, place, error);
  if (error)
    throw RunFailure("cannot copy " + file.string() + " to " + place.string() + ": " + error.message());
}

void Results::declare_series() {
  for (const Column& one : columns_.all())
    record_->declare(one.name, one.unit, one.description, scene_.units ? scene_.units->in_si(one.unit) : std::string());
}

void Results::remesh(const Body& body, const surface::BezierMap& map) {
  body_ = &body;
  if (writes_) nodes_.emplace(map, output::lagrange_mesh(body.space, body.unstressed, output::surfaces(body.space)));
}

std::optional<Resumed> Results::resumed() {
  if (!request_.resume) return {};
  return resuming(directory_, [this] { return read_run(); });
}

/// Reads the newest checkpoint and the rows of `run.h5` up to it. Throws UserError if the run cannot be continued from it.
Resumed Results::read_run() {
  const output::Saved saved = newest_checkpoint(directory_, ranks_);
  const std::string chosen = saved.file.path.filename();
  Resumed resumed{output::stored_state(saved.checkpoint), stored_totals(saved.checkpoint), saved.checkpoint};
  last_saved_ = resumed.totals.step;
  for (const Warning& warning : resumed.totals.warnings.shown) warnings_.push_back(warning.sentence), add_obstacle(warning.kind);
  coupling::together(writes_, [&] {
    record_.emplace(output::RunRecord::up_to(saved));
    run_ = saved.checkpoint.texts.at("run");
    record_->describe(request_.deck_text, origin());
    declare_series();
    set_aside(saved.damaged, chosen);
    snapshots_.emplace(output::SnapshotSeries::resumed(directory_, last_saved_, run_));
  });
  if (writes_ && !request_.quiet) std::printf("  resumed     from %s\n", chosen.c_str());
  return resumed;
}

/// Renames damaged snapshots that are newer than the chosen checkpoint, and warns about them.
void Results::set_aside(const std::vector<output::Damaged>& damaged, const std::string& chosen) {
  for (const auto& [path, reason] : damaged)
    warn(path.filename().string() + " is damaged (" + reason + ") and was renamed to " + output::set_aside(path).filename().string() +
         ": the run continues from " + chosen);
}

void Results::record(Columns& row) {
  coupling::take_first(row.values());
  const auto [own, declared] = std::ranges::mismatch(row.all(), columns_.all(), {}, &Column::name, &Column::name);
  if (own != row.all().end() || declared != columns_.all().end())
    throw std::logic_error("a row has the column " + (own == row.all().end() ? "none" : own->name) + " where the run declared " +
                           (declared == columns_.all().end() ? "none" : declared->name));
  coupling::together(writes_, [&] {
    record_->append(row.values());
    if (record_->rows() > 1 && Clock::now() < due_) return;
    try {
      write_files();
    } catch (...) {
      record_->truncate(record_->rows() - 1);  // the step is undone
      throw;
    }
  });
}

/// Writes `run.h5` if rows are missing in the file, then the snapshots that wait in memory.
void Results::write_files() {
  if (rows_written_ != record_->rows()) {
    const auto begun = Clock::now();
    rows_written_ = 0;
    record_->write(durable());
    const Clock::time_point now = Clock::now();
    due_ = now + std::max(50 * (now - begun), std::min<Clock::duration>(now - process_start_, std::chrono::seconds(1)));
    rows_written_ = record_->rows();
  }
  for (const auto& [step, bytes] : unwritten_snapshots_) output::write_whole(directory_ / output::snapshot_name(step), bytes, durable());
  unwritten_snapshots_.clear();
}

void Results::warn(const std::string& sentence) {
  warnings_.push_back(sentence);
  if (writes_ && !request_.of_ladder) std::fprintf(stderr, "tanktread: warning: %s\n", sentence.c_str());
}

void Results::warn(const Warning& warning) {
  add_obstacle(warning.kind);
  warn(warning.sentence);
}

void Results::add_obstacle(const std::string& kind) {
  const std::string why = accuracy::obstacle_of(kind);
  if (!why.empty() && std::ranges::find(obstacles_, why) == obstacles_.end()) obstacles_.push_back(why);
}

void Results::write_surface(const Net& surface) {
  coupling::together(writes_, [&] { output::write_whole(directory_ / output::surface_file, spline::iga_text(body_->space, surface), durable()); });
}

Results::Sampled Results::sample(const SurfaceSnapshot& snapshot, double time) {
  Sampled sampled;
  coupling::together(writes_, [&] {
    sampled = {time, nodes_->mesh(), output::shape_fields(*nodes_, snapshot.surface)};
    std::ranges::move(snapshot.fields(*nodes_), std::back_inserter(sampled.fields));
  });
  return sampled;
}

void Results::save(output::Checkpoint checkpoint, const motion::TimeState& state, const RunTotals& totals, const Sampled& snapshot) {
  coupling::together(writes_, [&] {
    complete(checkpoint, state, totals, snapshot.time);
    unwritten_snapshots_.emplace_back(totals.step, output::snapshot_file(checkpoint, snapshot.mesh, snapshot.fields));
    snapshots_->add(totals.step, snapshot.time);
    if (last_saved_ >= 0 && young() && rows_written_ != record_->rows()) return;
    write_files();
    if (young()) return;
    output::sync(directory_);
    snapshots_->write();
  });
  last_saved_ = totals.step;
}

void Results::complete(output::Checkpoint& checkpoint, const motion::TimeState& state, const RunTotals& totals, double picture_time) const {
  output::store(state, checkpoint);
  store(totals, checkpoint);
  checkpoint.numbers["picture time"] = picture_time;
  checkpoint.texts["deck"] = request_.deck_text;
  checkpoint.texts["run"] = run_;
  if (!scene_.has_time()) checkpoint.texts[output::not_resumed] = "it makes no time steps";
  checkpoint.texts["record"] = record_->checksum(static_cast<std::size_t>(totals.step) + 1);
}

int Results::close(const Account& account, const Phases& phases) {
  memory_ = peak_memory(ranks_);
  std::string missed;
  coupling::together(writes_, [&] {
    if (!unwritten_snapshots_.empty() || rows_written_ != record_->rows()) write_files();
    missed = finish(account, phases);
  });
  if (!output::reached_end(account.summary.status)) missed.clear();
  if (writes_) {
    if (!request_.quiet) std::fputs(output::closing_table(phases, account.summary.counts, directory_).c_str(), stdout);
    const std::string line = account.remark + (account.remark.empty() || missed.empty() ? "" : "; ") + missed;
    if (!line.empty()) std::fprintf(stderr, "tanktread: %s\n", line.c_str());
  }
  return coupling::error_of_any(missed).empty() ? Exit::done : Exit::missed;
}

/// Returns estimates of the errors of time integration and quadrature, and the remark that the error of the mesh is unknown.
output::Entries<std::string> Results::known_errors() const {
  output::Entries<std::string> errors;
  double steps = 0;
  for (const output::Series& series : record_->series())
    if (series.name == "step_error")
      for (const double error : series.values)
        if (error > 0) steps += error;
  if (steps > 0)
    errors.emplace_back("time integration", formatted("%.2g R_C: sum of the errors of all steps, root mean square over the points", steps));
  if (scene_.quadrature.rule == quadrature::LayerRule::adaptive)
    errors.emplace_back("quadrature", formatted("%.2g of the velocities: a fifth of Quadrature/tolerance", scene_.quadrature.tolerance / 5));
  errors.emplace_back("mesh", "unknown: --accuracy estimates it from several meshes");
  return errors;
}

/// Writes the summary. If a missed expectation has the key `not binding`, only warns about it. Returns one line with the other missed expectations,
/// which make the run fail.
std::string Results::finish(const Account& account, const Phases& phases) {
  output::Summary summary = account.summary;
  deck::SeriesTable table;
  for (const output::Series& series : record_->series()) {
    table[series.name] = series.values;
    summary.final.emplace_back(series.name, series.values.back());
    if (!series.si.empty()) summary.final_in_si.emplace_back(series.name, scene_.units->in_si(series.unit, series.values.back()));
  }
  summary.expect = deck::verdicts(scene_.expect.all, table, undefined_series(scene_));
  const std::string missed = deck::missed(summary.expect, [this](const std::string& sentence) { warn(sentence); });
  summary.seconds = with_earlier(phases, account.earlier);
  summary.memory = memory_;
  summary.numbers = numbers(scene_, *body_);
  summary.errors = known_errors();
  summary.warnings = warnings_;
  summary.obstacles = obstacles_;
  output::write_whole(directory_ / output::summary_file, output::yaml(summary));
  snapshots_->write();
  std::set<std::string> copies;
  for (const auto& [file, name] : scene_.files) copies.insert(name);
  if (!young()) output::sync_results(directory_, copies);
  return missed;
}

std::vector<std::string> names_of_series(const Scene& scene) {
  std::vector<std::string> names;
  for (const Column& one : columns(scene).all()) names.push_back(one.name);
  return names;
}

deck::UndefinedSeries undefined_series(const Scene& scene) {
  deck::UndefinedSeries undefined;
  for (const Column& one : columns(scene).all())
    if (!one.undefined_if.empty()) undefined[one.name] = one.undefined_if;
  return undefined;
}

std::vector<std::string> check_expectations(const Scene& scene) {
  deck::check_series(scene.expect.all, names_of_series(scene));
  const double last = scene.continuation.present ? scene.continuation.points : 0;
  return deck::too_late(scene.expect.all, scene.has_time() ? scene.time.final_time : last);
}

std::string stored_deck(const std::string& directory) {
  return resuming(directory, [&] { return newest_checkpoint(directory, coupling::Ranks()).checkpoint.texts.at("deck"); });
}

}  // namespace tanktread
