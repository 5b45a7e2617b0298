#include "base/text_file.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "base/errors.hpp"

namespace tanktread {

std::string text_of_file(const std::filesystem::path& file, const std::string& what, std::size_t most) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) throw UserError(what + " does not exist.");
  if (fs::is_directory(status)) throw UserError(what + " is a directory, not a file.");
  if (error) throw UserError(what + " cannot be read: " + error.message() + ".");
  if (!fs::is_regular_file(status)) throw UserError(what + " is not a regular file, but a pipe or a device.");
  if (fs::file_size(file, error) > most) throw UserError(what + " is larger than " + std::to_string(most / 1'000'000) + " MB.");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw UserError(what + " cannot be read.");
  std::string text(std::istreambuf_iterator<char>(stream), {});
  const std::string byte_order_mark = "\xEF\xBB\xBF";  // some editors write this mark at the beginning of UTF-8 files
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<CsvRow> csv_rows(const std::string& text, const std::string& heading) {
  std::vector<CsvRow> rows;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty() || (rows.empty() && line.starts_with(heading))) continue;
    rows.push_back({number, {}});
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().fields.push_back(trimmed(field));
  }
  return rows;
}

double csv_number(const std::string& field, const std::string& where) {
  std::size_t used = 0;
  double value = NAN;
  try {
    value = std::stod(field, &used);
  } catch (const std::logic_error&) {
  }
  if (used != field.size() || !(std::abs(value) < 1e75)) throw UserError(where + "\"" + field + "\" is not a number below 1e75 in size.");
  return value;
}

}  // namespace tanktread
