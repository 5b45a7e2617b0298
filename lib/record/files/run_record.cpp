#include "record/files/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "record/files/hdf.hpp"

namespace tanktread::output {

RunRecord::RunRecord(std::filesystem::path path, std::string deck, std::map<std::string, std::string> provenance)
    : path_(std::move(path)), deck_(std::move(deck)), provenance_(std::move(provenance)) {}

RunRecord RunRecord::load(const std::filesystem::path& path) try {
  const hdf::Id file = hdf::open(path);
  RunRecord record(path, hdf::read_text(file, "deck"), {});
  for (const auto& key : hdf::attribute_names(file, "provenance")) record.provenance_[key] = hdf::read_attribute(file, "provenance", key);
  for (const auto& name : hdf::datasets(file, "series")) {
    const std::string at = "series/" + name;
    hdf::Shape shape;
    record.series_.push_back(
        {name, hdf::read_attribute(file, at, "unit"), hdf::read_attribute(file, at, "description"), hdf::read_doubles(file, at, shape), {}});
    if (std::ranges::count(hdf::attribute_names(file, at), "SI") > 0) record.series_.back().si = hdf::read_attribute(file, at, "SI");
    if (record.series_.back().values.size() != record.rows()) throw std::runtime_error("series of unequal length");
  }
  return record;
} catch (const std::runtime_error& error) {
  throw UserError("the record " + path.string() + " is missing or damaged (" + error.what() + ")");
}

RunRecord RunRecord::up_to(const Saved& saved) {
  const auto& texts = saved.checkpoint.texts;
  const std::string name = saved.file.path.filename();
  if (!texts.contains("run") || !texts.contains("record")) throw UserError(another_version);
  if (const double step = saved.checkpoint.numbers.at("steps"); step != saved.file.step)
    throw UserError(name + formatted(" contains step %.0f, but its name states another step", step));
  RunRecord record = load(saved.file.path.parent_path() / record_file);
  const auto run = record.provenance_.find("run");
  if (run == record.provenance_.end() || run->second != texts.at("run")) throw UserError(name + " and run.h5 belong to different runs");
  const auto rows = static_cast<std::size_t>(saved.file.step) + 1;
  const auto matches = [&](bool with_undefined) { return record.checksum(rows, with_undefined) == texts.at("record"); };
  if (record.rows() < rows || (!matches(false) && !matches(true)))
    throw UserError("the rows of run.h5 up to " + name + " are damaged: they differ from what was written");
  record.truncate(rows);
  return record;
}

std::string obstacle_to_resuming(const std::filesystem::path& directory) try {
  const std::optional<Saved> saved = newest_checkpoint(directory);
  if (!saved) return "there is no checkpoint in this directory";
  if (const auto why = saved->checkpoint.texts.find(not_resumed); why != saved->checkpoint.texts.end()) return why->second;
  RunRecord::up_to(*saved);
  stored_state(saved->checkpoint);
  return {};
} catch (const UserError& error) {
  return error.what();
} catch (const std::out_of_range&) {
  return another_version;
}

void RunRecord::declare(std::string name, std::string unit, std::string description, std::string si) {
  const auto old = std::ranges::find(series_, name, &Series::name);
  std::vector<double> values(rows(), std::numeric_limits<double>::quiet_NaN());
  if (old != series_.end()) {  // The series was loaded from a file. It moves to the end, because append() needs the series in the order in which the
                               // program declares them.
    values = std::move(old->values);
    series_.erase(old);
  }
  series_.push_back({std::move(name), std::move(unit), std::move(description), std::move(values), std::move(si)});
}

void RunRecord::append(std::span<const double> row) {
  if (row.size() != series_.size()) throw std::logic_error("a row needs one value for every series");
  for (std::size_t i = 0; i < row.size(); ++i) series_[i].values.push_back(row[i]);
}

void RunRecord::truncate(std::size_t rows) {
  for (Series& one : series_) one.values.resize(std::min(rows, one.values.size()));
}

void RunRecord::describe(std::string deck, std::map<std::string, std::string> provenance) {
  deck_ = std::move(deck);
  provenance_ = std::move(provenance);
}

const std::vector<double>& RunRecord::values(std::string_view name) const {
  const auto it = std::ranges::find(series_, name, &Series::name);
  if (it == series_.end()) throw std::out_of_range("no series " + std::string(name));
  return it->values;
}

void RunRecord::write(Durable durable) const {
  const hdf::Id file = hdf::new_file();
  hdf::write(file, "deck", deck_);
  const hdf::Id provenance = hdf::write_group(file, "provenance"), series = hdf::write_group(file, "series");
  for (const auto& [key, text] : provenance_) hdf::attribute(provenance, key, text);
  const auto add = [](hid_t group, const std::string& name, const Series& one) {
    const hdf::Id set = hdf::write(group, name, one.values, {one.values.size()});
    hdf::attribute(set, "unit", one.unit);
    hdf::attribute(set, "description", one.description);
    if (!one.si.empty()) hdf::attribute(set, "SI", one.si);
  };
  for (const Series& one : series_) add(series, one.name, one);
  for (const Series& one : errors_) add(file, "error/" + one.name, one);
  write_whole(path_, hdf::image(file), durable);
}

std::string RunRecord::checksum(std::size_t rows, bool with_undefined) const {
  std::map<std::string_view, const Series*> by_name;
  for (const Series& one : series_) by_name[one.name] = &one;
  Checksum sum;
  for (const auto& [name, one] : by_name) {
    const auto values = std::span(one->values).first(std::min(rows, one->values.size()));
    if (!with_undefined && std::ranges::all_of(values, [](double value) { return std::isnan(value); })) continue;
    sum.add(one->name);
    for (const double value : values) sum.add(value);
  }
  return sum.digits();
}

}  // namespace tanktread::output
