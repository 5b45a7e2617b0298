#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tanktread {

/// Returns the text of a file without its byte-order mark. `what` is the name of the file in messages (`The deck a.yaml`). Throws UserError if the
/// file is missing, unreadable, not a regular file (a directory, or a pipe, which might never end), or longer than `most` bytes.
std::string text_of_file(const std::filesystem::path& file, const std::string& what, std::size_t most);

/// Returns the text without blanks at its beginning and end.
std::string trimmed(const std::string& text);

/// Fields of one line of a CSV file: the texts between commas, without blanks around them.
struct CsvRow {
  int line;
  std::vector<std::string> fields;
};

/// Returns all lines of a CSV text that are not empty. `#` begins a comment. The first row is left out if it begins with `heading`, the column names.
std::vector<CsvRow> csv_rows(const std::string& text, const std::string& heading);

/// Returns the number in a field. Throws UserError, with `where` before the sentence, if the field is not a number of magnitude below 1e75.
double csv_number(const std::string& field, const std::string& where);

}  // namespace tanktread
