#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tanktread {

/// The text of a file, which `what` names in messages (`The deck a.yaml`). Throws UserError where it is missing, unreadable, no regular file (a
/// directory, a pipe, which might never end), or longer than `most` bytes.
std::string text_of_file(const std::filesystem::path& file, const std::string& what, std::size_t most);

/// Without the blanks around it.
std::string trimmed(const std::string& text);

/// What stands between the commas of one line, without blanks around it.
struct CsvRow {
  int line;
  std::vector<std::string> fields;
};

/// All lines of a text with something on them: `#` begins a comment, and a first row that begins with `heading` names columns and is left out.
std::vector<CsvRow> csv_rows(const std::string& text, const std::string& heading);

/// Throws UserError, a sentence after `where`, unless the field is a number below 1e75 in size.
double csv_number(const std::string& field, const std::string& where);

}  // namespace tanktread
