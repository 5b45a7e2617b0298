#pragma once
// Columns of the record of a run (`/series` in run.h5). Each object (run, particle, wall, load, field) declares its columns together with their
// values.

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace tanktread {

struct Column {
  std::string name, unit;
  std::string description;
  std::string undefined_if = {};  ///< condition under which the value is NaN, as a clause; empty if the value is always defined
  /// Text for the manual about the runs that have this column. The manual generates a list of the kinds of runs and particles that have it. An empty
  /// text leaves the list unchanged, a text that begins with a semicolon (`; in a tube`) is appended to it, and any other text replaces it.
  std::string where = {};
};

/// The columns of one row and their values.
///
/// An owner (the run, a particle, a wall, a load, a field) adds its columns in one function. The function is called at each recorded state. If only
/// the names are needed, it is called once without a state, and its values, which may be NaN, are ignored. Conditions on a column depend only on the
/// deck, so that every row has the same columns.
class Columns {
 public:
  /// `every`: if true, `when` always returns true, so that the columns of all decks are listed.
  explicit Columns(bool every = false) : every_(every) {}

  /// Returns whether to add a column that exists only if `condition` is true. If all columns are listed (`every`), always returns true.
  bool when(bool condition) const { return condition || every_; }

  /// Adds a column and its value. The clause `undefined_if` is appended to the description.
  void add(double value, Column column);

  /// Adds one column per component of `values`. `components`: names of the components, separated by spaces. The name of the component is appended to
  /// the name of the column and replaces `#` in the description.
  void add(const Eigen::Ref<const Eigen::VectorXd>& values, std::string_view components, const Column& column);

  /// Adds the columns of another row with `prefix` before each name: `<particle>/` if there are several particles.
  void append(const Columns& other, const std::string& prefix = {});

  /// Sorts the columns by increasing rank(name). Columns of equal rank keep the order in which they were added.
  void sort(const std::function<std::size_t(const std::string& name)>& rank);

  /// Throws RunFailure with the name of the column if a value is NaN although its column is always defined (`undefined_if` is empty).
  void check() const;

  std::size_t size() const { return columns_.size(); }
  const std::vector<Column>& all() const& { return columns_; }
  std::vector<Column> all() && { return std::move(columns_); }
  const std::vector<double>& values() const { return values_; }
  std::vector<double>& values() { return values_; }

  /// Returns the value of one column. Throws std::out_of_range if no column has this name.
  double value(std::string_view name) const;

  /// Returns the values of the columns `<particle>/<name>` in the order of the particles, or the value of the column `name` if there are no such
  /// columns.
  std::vector<double> of_particles(std::string_view name) const;

  double smallest(std::string_view name) const;  ///< returns the smallest value of `of_particles(name)`; 0 if there are none
  double largest(std::string_view name) const;   ///< returns the largest value of `of_particles(name)`; 0 if there are none

 private:
  bool every_;
  std::vector<Column> columns_;
  std::vector<double> values_;
};

}  // namespace tanktread
