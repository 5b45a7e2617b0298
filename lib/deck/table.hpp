#pragma once
// Tables of numbers that a deck names: positions, histories, outlines.

#include <memory>
#include <string>
#include <vector>

namespace tanktread::deck {

class Units;

/// File of a table that the deck names.
struct TableFile {
  std::string path;
  std::shared_ptr<const Units> units = {};  ///< units of the deck; null if the deck does not set them
};

/// Column that a table should have.
struct TableColumn {
  std::string name;
  std::string unit;       ///< unit in terms of the units of the deck, for example `length`; `1` if dimensionless
  bool any_name = false;  ///< true if a column of another name is taken for this one, provided that there is only one other
};

/// Columns that a table should have. The last ones are optional: `counts` contains the possible numbers of columns. If `word` is not empty, it may be
/// the last entry of any row.
struct TableForm {
  std::vector<TableColumn> columns;
  std::vector<std::size_t> counts;
  std::string word = {};
};

struct TableRow {
  int line;
  std::vector<double> numbers;  ///< in the order of the form, in the units of the deck
  bool marked;                  ///< true if the row ends with the word of the form
};

/// Returns the rows of a table. `what`: name of the file in messages. The rules are those of tanktread.tables (postproc/tanktread/tables.py):
///
/// - Semicolons, tabs, commas or spaces separate the columns. Numbers have decimal points or, in all columns, decimal commas.
/// - `#` begins a comment, and so does `%` at the beginning of a line. Empty lines and trailing separators have no meaning.
/// - Lines before the first row of numbers are titles, names of the columns, and units. Names may also be in the last comment before the first row.
///   The names decide which column is which. Numbers of a column with a unit are converted.
/// - What has two meanings is refused: 1,234 may be a thousand, and 0,5,1,2 may be two numbers or four.
///
/// Throws UserError with the line, the separator that was found, and what was expected.
std::vector<TableRow> read_table(const TableFile& file, const std::string& what, const TableForm& form);

}  // namespace tanktread::deck
