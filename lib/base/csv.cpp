#include "base/csv.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/errors.hpp"

namespace tanktread {

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
