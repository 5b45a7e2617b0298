#pragma once
// Columns of the record of a run (`/series` in run.h5). What a column belongs to declares it together with its value.

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
  std::string where = {};         ///< for the manual: what a run must have, `; in a tube`
};

/// The columns of one row and their values.
///
/// An owner (the run, a particle, a wall, a load, a field) adds its columns to this, in one function. The function is called at each recorded state,
/// and once without a state if only the names are wanted: the values that it gives then, NaN too, are not used. Conditions on a column
/// depend on the deck only, so that every row has the same columns.
class Columns {
 public:
  /// `every`: lists the columns of all decks, because `when` is always true.
  explicit Columns(bool every = false) : every_(every) {}

  /// Returns whether a column with this condition is to be added.
  bool when(bool condition) const { return condition || every_; }

  /// Adds a column and its value. The clause `undefined_if` is appended to the description.
  void add(double value, Column column);

  /// Adds one column per component, separated by spaces in `components`. The component is appended to the name and replaces `#` in the description.
  void add(const Eigen::Ref<const Eigen::VectorXd>& values, std::string_view components, const Column& column);

  /// Adds the columns of another row, each with the prefix before its name: of one of several particles, `<particle>/`.
  void append(const Columns& other, const std::string& prefix = {});

  /// Sorts by increasing rank of the name, and columns of equal rank in the order in which they were added.
  void sort(const std::function<std::size_t(const std::string& name)>& rank);

  /// Throws RunFailure, which names the column, if a value is NaN and its column is always defined.
  void check() const;

  std::size_t size() const { return columns_.size(); }
  const std::vector<Column>& all() const& { return columns_; }
  std::vector<Column> all() && { return std::move(columns_); }
  const std::vector<double>& values() const { return values_; }
  std::vector<double>& values() { return values_; }

  /// Returns the value of one column. Throws std::out_of_range if there is none of this name.
  double value(std::string_view name) const;

  /// Returns the values of `<particle>/<name>` in the order of the particles. If no particle has a name, the value of `name`.
  std::vector<double> of_particles(std::string_view name) const;

  /// Returns the smallest and the largest of them; 0 if there are none.
  double smallest(std::string_view name) const;
  double largest(std::string_view name) const;

 private:
  bool every_;
  std::vector<Column> columns_;
  std::vector<double> values_;
};

}  // namespace tanktread
