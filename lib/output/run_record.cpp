#include "output/run_record.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/errors.hpp"
#include "output/checksum.hpp"
#include "output/hdf.hpp"

namespace tanktread::output {

/// The file as it stands in memory.
struct RunRecord::Image {
  hdf::Id file;
  std::vector<hdf::Id> columns;
  std::size_t rows, capacity;
};

RunRecord::RunRecord(std::filesystem::path path, std::string deck, std::map<std::string, std::string> provenance)
    : path_(std::move(path)), deck_(std::move(deck)), provenance_(std::move(provenance)) {}
RunRecord::~RunRecord() = default;
RunRecord::RunRecord(RunRecord&&) noexcept = default;

RunRecord RunRecord::load(const std::filesystem::path& path) try {
  const hdf::Id file = hdf::open(path);
  RunRecord record(path, hdf::read_text(file, "deck"), {});
  for (const auto& key : hdf::attribute_names(file, "provenance")) record.provenance_[key] = hdf::read_attribute(file, "provenance", key);
  const hdf::Id series = hdf::group(file, "series");
  for (const auto& name : hdf::datasets(series)) {
    hdf::Shape shape;
    record.series_.push_back({name, hdf::read_attribute(series, name, "unit"), hdf::read_attribute(series, name, "description"),
                              hdf::read_doubles(series, name, shape)});
    if (record.series_.back().values.size() != record.rows()) throw std::runtime_error("series of unequal length");
  }
  return record;
} catch (const std::runtime_error& error) {
  throw UserError("the record " + path.string() + " is missing or damaged (" + error.what() + ")");
}

void RunRecord::declare(std::string name, std::string unit, std::string description) {
  image_.reset();
  const auto old = std::ranges::find(series_, name, &Series::name);
  if (old == series_.end()) {
    const std::vector<double> unknown(rows(), std::numeric_limits<double>::quiet_NaN());
    series_.push_back({std::move(name), std::move(unit), std::move(description), unknown});
    return;
  }
  // Rows are given in the order of declaration: a series that was loaded moves behind those declared so far.
  Series known = std::move(*old);
  series_.erase(old);
  known.unit = std::move(unit);
  known.description = std::move(description);
  series_.push_back(std::move(known));
}

void RunRecord::append(std::span<const double> row) {
  if (row.size() != series_.size()) throw std::logic_error("a row needs one value for every series");
  for (std::size_t i = 0; i < row.size(); ++i) series_[i].values.push_back(row[i]);
}

void RunRecord::truncate(std::size_t rows) {
  image_.reset();
  for (Series& one : series_) one.values.resize(std::min(rows, one.values.size()));
}

void RunRecord::describe(std::string deck, std::map<std::string, std::string> provenance) {
  image_.reset();
  deck_ = std::move(deck);
  provenance_ = std::move(provenance);
}

const std::vector<double>& RunRecord::values(std::string_view name) const {
  const auto it = std::ranges::find(series_, name, &Series::name);
  if (it == series_.end()) throw std::out_of_range("no series " + std::string(name));
  return it->values;
}

void RunRecord::lay_out() {
  image_.reset();
  Image image{hdf::new_file(), {}, 0, rows() + std::max<std::size_t>(63, rows() / 8)};
  hdf::write(image.file, "deck", deck_);
  const hdf::Id provenance = hdf::new_group(image.file, "provenance"), series = hdf::new_group(image.file, "series");
  for (const auto& [key, text] : provenance_) hdf::attribute(provenance, ".", key, text);
  for (const Series& one : series_) {
    image.columns.push_back(hdf::new_column(series, one.name, image.capacity));
    hdf::attribute(series, one.name, "unit", one.unit);
    hdf::attribute(series, one.name, "description", one.description);
  }
  image_ = std::make_unique<Image>(std::move(image));
}

void RunRecord::write(Durable durable) {
  if (!image_ || rows() > image_->capacity) lay_out();
  if (rows() > image_->rows)
    for (std::size_t i = 0; i < series_.size(); ++i) hdf::grow(image_->columns[i], series_[i].values, image_->rows);
  image_->rows = rows();
  write_whole(path_, hdf::image(image_->file), durable);
}

std::string RunRecord::checksum(std::size_t rows) const {
  std::map<std::string_view, const Series*> by_name;
  for (const Series& one : series_) by_name[one.name] = &one;
  Checksum sum;
  for (const auto& [name, one] : by_name) {
    sum.add(one->name);
    for (const double value : std::span(one->values).first(std::min(rows, one->values.size()))) sum.add(value);
  }
  return sum.digits();
}

}  // namespace tanktread::output
