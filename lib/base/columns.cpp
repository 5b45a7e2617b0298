#include "base/columns.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/errors.hpp"

namespace tanktread {

void Columns::add(double value, Column column) {
  if (!column.undefined_if.empty()) column.description += "; NaN if " + column.undefined_if;
  columns_.push_back(std::move(column));
  values_.push_back(value);
}

void Columns::add(const Eigen::Ref<const Eigen::VectorXd>& values, std::string_view components, const Column& column) {
  std::istringstream names{std::string(components)};
  std::string component;
  for (Eigen::Index k = 0; names >> component; ++k) {
    assert(k < values.size());
    Column one = column;
    one.name += component;
    if (const auto at = one.description.find('#'); at != std::string::npos) one.description.replace(at, 1, component);
    add(values[k], std::move(one));
  }
}

void Columns::append(const Columns& other, const std::string& prefix) {
  for (Column column : other.columns_) {
    column.name.insert(0, prefix);
    columns_.push_back(std::move(column));
  }
  values_.insert(values_.end(), other.values_.begin(), other.values_.end());
}

void Columns::sort(const std::function<std::size_t(const std::string& name)>& rank) {
  std::vector<std::pair<std::size_t, std::size_t>> order;  // sorting rank and original index of each column
  for (const Column& column : columns_) order.emplace_back(rank(column.name), order.size());
  std::ranges::sort(order);
  Columns sorted(every_);
  for (const auto& [unused, k] : order) {
    sorted.columns_.push_back(std::move(columns_[k]));
    sorted.values_.push_back(values_[k]);
  }
  *this = std::move(sorted);
}

void Columns::check() const {
  for (std::size_t k = 0; k < size(); ++k)
    if (std::isnan(values_[k]) && columns_[k].undefined_if.empty()) throw RunFailure("the series " + columns_[k].name + " is NaN");
}

double Columns::value(std::string_view name) const {
  const auto at = std::ranges::find(columns_, name, &Column::name);
  if (at == columns_.end()) throw std::out_of_range("there is no series '" + std::string(name) + "'");
  return values_[static_cast<std::size_t>(at - columns_.begin())];
}

std::vector<double> Columns::of_particles(std::string_view name) const {
  std::vector<double> found;
  for (std::size_t k = 0; k < size(); ++k)
    if (columns_[k].name.ends_with("/" + std::string(name))) found.push_back(values_[k]);
  if (found.empty() && std::ranges::count(columns_, name, &Column::name) > 0) found.push_back(value(name));
  return found;
}

double Columns::smallest(std::string_view name) const {
  const std::vector<double> all = of_particles(name);
  return all.empty() ? 0 : std::ranges::min(all);
}

double Columns::largest(std::string_view name) const {
  const std::vector<double> all = of_particles(name);
  return all.empty() ? 0 : std::ranges::max(all);
}

}  // namespace tanktread
