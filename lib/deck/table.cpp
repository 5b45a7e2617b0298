#include "deck/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <ranges>
#include <regex>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/text_file.hpp"
#include "deck/units.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {
namespace {

using Texts = std::vector<std::string>;

constexpr std::size_t most_bytes = 100'000'000;
const std::map<char, const char*> names_of_separators{{';', "semicolons"}, {'\t', "tabs"}, {',', "commas"}, {' ', "spaces"}};

/// Line of a file. `marked`: whether the word of the form follows the text.
struct Line {
  int number;
  std::string text;
  bool marked = false;
};

/// Fields of a row of numbers.
struct Fields {
  int line;
  Texts texts;
  bool marked;
};

/// Lines before the first row of numbers, and all rows.
struct Content {
  std::vector<Line> head;
  std::vector<Fields> rows;
};

/// Names and units of all columns; a unit is empty if it is not stated.
struct Header {
  int line;
  Texts names, units;
};

/// Mistake in a line of a table, for one of the possible separators.
struct Wrong {
  int line;
  std::string text;
};

std::string replaced(const std::string& text, const char* pattern, const char* by) {
  return std::regex_replace(text, std::regex(pattern), by);
}

bool digits(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == text.npos; }

/// Returns the number in a field, which has a decimal point or comma; infinity if it is too large; nothing if the field is not a number.
std::optional<double> number(std::string field) {
  if (field.find(',') + 1 == field.size() || field.starts_with("+-")) return {};
  for (char& c : field) c = c == ',' ? '.' : c == 'd' || c == 'D' ? 'e' : c;
  double value = 0;
  const char* end = field.data() + field.size();
  const auto [rest, error] = std::from_chars(field.data() + field.starts_with('+'), end, value);
  if (error == std::errc::invalid_argument || rest != end || (!digits(field.substr(field.size() - 1)) && !field.ends_with('.'))) return {};
  return error == std::errc() ? value : std::numeric_limits<double>::infinity();
}

bool is_number(const std::string& field) { return number(field).has_value(); }

bool is_unit(const std::string& text) {
  static const std::string one =
      "(?:(?:milli|micro|nano|pico|centi|kilo)?(?:met(?:er|re)|second|newton|pascal|gram|joule|poise|dyne)s?|microns?|sec|min|minutes?|"
      "hours?"
      "|deg|degrees?|rad|radians?|px|pixels?|(?:[fpnumcdkMG]|µ|μ)?(?:m|s|N|Pas?|g|J|Hz|P|dyn)|h|°|%|1)"
      "(?:(?:\\^|\\*\\*)?(?:-|⁻)?(?:[0-9]|⁰|¹|²|³|⁴)?)?";
  static const std::regex unit(one + "(?:(?: |\\*|/|·|\\.)+" + one + ")*|-|–|");
  return text.size() < 100 && std::regex_match(text, unit);
}

/// Returns the name in lower case without blanks and underscores. Names with the same meaning have the same key.
std::string key(const std::string& name) {
  static const std::map<std::string, std::string> synonyms{{"x", "x1"},        {"y", "x2"},        {"z", "x3"},  {"points:0", "x1"},
                                                           {"points:1", "x2"}, {"points:2", "x3"}, {"t", "time"}};
  const std::string plain = lower_case(replaced(name, "[\\s_]", ""));
  const auto found = synonyms.find(plain);
  return found == synonyms.end() ? plain : found->second;
}

std::pair<std::string, std::string> name_and_unit(const std::string& field) {
  const std::string text = replaced(field, "^[\\s,;:]+|[\\s,;:]+$", "");
  // the unit is in brackets, after a slash or a comma, or the last word
  for (const char* pattern : {"(.*?)\\s*[\\[(]\\s*(.*?)\\s*[\\])]", "(.+?)\\s*/\\s*(.+)", "(.+),\\s*(.+)", "(.+)[ _]([^\\s\\d-]\\S*)"})
    if (std::smatch found; std::regex_match(text, found, std::regex(pattern)) && is_unit(found[2]))
      return {found[1], found.str(2).empty() ? "-" : found.str(2)};
  return {text, ""};
}

/// Returns the fields of a line without blanks and quotes around them, and without empty ones at the end.
Texts fields(const std::string& text, char separator) {
  Texts found{""};
  bool quoted = false;
  for (const char c : separator == ' ' ? trimmed(text) : text) {
    quoted ^= c == '"';
    if (c != separator || quoted)
      found.back() += c;
    else if (separator != ' ' || !found.back().empty())
      found.emplace_back();
  }
  for (std::string& field : found) {
    field = trimmed(field);
    if (field.size() > 1 && field.starts_with('"') && field.ends_with('"')) field = trimmed(field.substr(1, field.size() - 2));
  }
  while (!found.empty() && found.back().empty()) found.pop_back();
  return found;
}

/// Returns the fields of a line of `count` names, or nothing if it is no such line. `own`: whether the line has the separator of the rows; if not, it
/// may have another one.
Texts names(const std::string& text, char separator, std::size_t count, bool own) {
  std::vector<Texts> tries{fields(text, separator)};
  if (separator == ' ' || (!own && text.find(separator) == text.npos)) {
    const std::string joined = replaced(text, "\\s+(?=[\\[(])|\\s*(/)\\s*", "$1");             // without blanks before units
    if (separator != ',') tries = {fields(text, ';'), fields(text, '\t'), fields(text, ',')};  // 0,5 below a;b may be one number
    tries.insert(tries.end(), {fields(replaced(trimmed(text), " {2,}", "\t"), '\t'), fields(joined, ' '), fields(text, ' ')});
  }
  const auto found = std::ranges::find(tries, count, &Texts::size);
  return found == tries.end() ? Texts{} : *found;
}

/// Returns the fields of a line of units, with or without brackets, or nothing if it is no such line.
Texts units(const std::string& text, char separator, std::size_t count) {
  Texts found = fields(text, separator);
  found.resize(std::max(found.size(), count));
  for (std::string& field : found) field = replaced(field, "^[\\[(]\\s*(.*?)\\s*[\\])]$", "$1");
  return found.size() == count && std::ranges::all_of(found, is_unit) ? found : Texts{};
}

/// Returns names and units of the columns, if the lines state them. `head`: whether the lines are those before the first row; otherwise comments.
std::optional<Header> header(const std::vector<Line>& lines, bool head, char separator, std::size_t count, const TableForm& form) {
  const bool own = std::ranges::any_of(lines, [&](const Line& line) { return !names(line.text, separator, count, true).empty(); });
  for (auto line = lines.begin(); line != lines.end(); ++line) {
    Header found{line->number, names(line->text, separator, count, own), Texts(count)};
    if (found.names.empty()) continue;
    const auto next = line + 1;
    const Texts below = next == lines.end() ? Texts(count) : next + 1 == lines.end() ? units(next->text, separator, count) : Texts{};
    if (below.empty() && !head) continue;
    if (below.empty()) throw Wrong{next->number, "this line is neither numbers nor the units of the columns: begin it with #"};
    bool known = head;
    for (std::size_t k = 0; k < count; ++k) {
      std::tie(found.names[k], found.units[k]) = name_and_unit(found.names[k]);
      if (!below[k].empty()) found.units[k] = below[k];
      if (found.units[k] == "-" || found.units[k] == "–") found.units[k] = "1";
      known = known || !found.units[k].empty() ||
              std::ranges::count(form.columns, key(found.names[k]), [](const auto& one) { return key(one.name); });
    }
    if (known) return found;
  }
  if (head && !lines.empty())
    throw Wrong{lines.back().number, formatted("this line does not name as many columns as a row has numbers, %zu", count) +
                                         (separator == ',' ? "; decimal commas need semicolons or tabs between the columns" : "")};
  return {};
}

/// Returns the indices of the columns of the form; empty if the names do not decide them.
std::vector<std::size_t> order(const Texts& names, const TableForm& form) {
  Texts keys;
  for (const std::string& name : names) keys.push_back(key(name));
  std::vector<std::size_t> picked;
  std::optional<std::size_t> missing;
  for (const TableColumn& column : form.columns) {
    const auto at = std::ranges::find(keys, key(column.name));
    if (std::ranges::count(keys, key(column.name)) > 1) return {};
    if (at != keys.end())
      picked.push_back(static_cast<std::size_t>(at - keys.begin()));
    else if (const std::size_t k = picked.size(); column.any_name && !missing)
      missing = k, picked.push_back(names.size());
    else if (k < form.counts.front())
      return {};
  }
  for (std::size_t k = 0; k < names.size(); ++k)
    if (std::ranges::count(picked, k) == 0 && !std::ranges::count(Texts{"", "id", "index", "no", "nr"}, keys[k])) {
      if (!missing) return {};
      picked[*std::exchange(missing, {})] = k;
    }
  return missing || std::ranges::count(form.counts, picked.size()) == 0 ? std::vector<std::size_t>{} : picked;
}

/// Throws Wrong at the first row that does not hold numbers, as many as the first one.
void check(const std::vector<Fields>& rows, char separator) {
  const Fields *commas = nullptr, *points = nullptr;
  std::string comma, point;
  bool thousands = true;
  const std::size_t count = rows.front().texts.size();
  for (const Fields& row : rows) {
    for (const std::string& field : row.texts) {
      const std::optional<double> value = number(field);
      if (!value) throw Wrong{row.line, field.empty() ? "a value is missing" : in_quotes(shortened(field, 80)) + " is not a number"};
      if (!(std::abs(*value) < 1e75)) throw Wrong{row.line, in_quotes(field) + " is not a number below 1e75 in size"};
      if ((separator == ',' || separator == ' ') && field.size() > 1 && field.front() == '0' && digits(field))
        throw Wrong{row.line, in_quotes(field) +
                                  " may be the end of a number: decimal commas need semicolons or tabs between the columns, and "
                                  "separators of thousands are not accepted"};
      if (field.find(',') != field.npos) {
        if (!commas) commas = &row, comma = field;
        thousands = thousands && std::regex_match(field, std::regex("[+-]?[1-9]\\d{0,2},\\d{3}"));
      } else if (!points && field.find('.') != field.npos) {
        points = &row, point = field;
      }
    }
    if (const std::size_t n = row.texts.size(); n != count || count < 2)
      throw Wrong{row.line, formatted("this row holds %zu number%s", n, n > 1 ? "s" : "") +
                                (n == count ? "" : formatted(", but the first row %zu", count))};
  }
  if (commas && points)
    throw Wrong{commas->line, formatted("\"%s\" has a decimal comma, but \"%s\" in line %d has a decimal point", comma.c_str(),
                                        point.c_str(), points->line)};
  if (commas && thousands)
    throw Wrong{commas->line, formatted("\"%s\" may be %s or %s: write decimal points, and no separators of thousands", comma.c_str(),
                                        replaced(comma, ",", ".").c_str(), replaced(comma, ",", "").c_str())};
}

/// Returns the content of a table with this separator. Throws Wrong if the separator is another one.
Content content(const std::vector<Line>& lines, char separator) {
  Content found;
  for (const Line& line : lines) {
    Fields row{line.number, fields(line.text, separator), line.marked};
    if (!found.rows.empty() || std::ranges::any_of(row.texts, is_number)) {
      found.rows.push_back(std::move(row));
      continue;
    }
    for (const std::string& field : row.texts)
      if (std::regex_match(lower_case(field), std::regex("nan|n/?a|null|none|[+-]?inf")))
        throw Wrong{line.number, in_quotes(field) + " is not a number"};
    found.head.push_back(line);
  }
  if (found.rows.empty()) throw Wrong{lines.front().number, "no row of numbers follows"};
  check(found.rows, separator);
  return found;
}

/// Throws Wrong if the number of columns, of which no names are known, is wrong or uncertain.
void check_unnamed(const std::vector<Fields>& rows, char separator, const TableForm& form) {
  const std::size_t count = rows.front().texts.size();
  if (std::ranges::count(form.counts, count) == 0) throw Wrong{rows.front().line, formatted("this row holds %zu numbers", count)};
  bool halves = (separator == ',' || separator == ' ') && count % 2 == 0 && count / 2 >= form.counts.front();
  for (const Fields& row : rows)
    for (std::size_t k = 0; halves && k < count; ++k) {
      const std::string& field = row.texts[k];
      const bool sign = k % 2 == 0 && (field.starts_with('-') || field.starts_with('+'));
      halves = digits(field.substr(sign)) && (k % 2 == 0 || separator == ',' || field.size() == 3);
    }
  if (halves)
    throw Wrong{rows.front().line,
                formatted("these may be %zu whole numbers, or %zu with decimal commas or separators of thousands: name the columns "
                          "in the first line, or write decimal points",
                          count, count / 2)};
}

/// Returns the number of the deck's units of a column in the unit that the file states; 1 if it states none.
double factor(const TableColumn& column, const std::string& unit, int line, const Units* deck) {
  if (unit.empty() || (unit == "1" && (column.unit == "1" || !deck))) return 1;
  const auto refuse = [&](const std::string& why) {
    throw Wrong{line, "the column " + column.name + " has the unit " + unit + ", but " + why};
  };
  if (column.unit == "degree" && (unit.starts_with("deg") || unit == "°")) return 1;
  if (!deck) refuse("the deck has no section Units: add it, or remove the unit from this line");
  try {
    return deck->number("1 " + unit, column.unit);
  } catch (const std::invalid_argument&) {
    refuse(column.unit == "1" ? "should have none" : "this is not a known unit of " + column.unit);
  }
  return 1;
}

std::vector<TableRow> table(const Content& content, const std::vector<Line>& notes, char separator, const TableForm& form,
                            const Units* deck) {
  const std::size_t count = content.rows.front().texts.size();
  std::vector<Line> last;  // comments directly before the first row
  for (const Line& note : notes)
    if (note.number < content.rows.front().line) last.push_back(note);
  if (last.size() > 2) last.erase(last.begin(), last.end() - 2);
  const bool head = !content.head.empty();
  const auto found = header(head ? content.head : last, head, separator, count, form);
  std::vector<std::size_t> columns(count);
  std::vector<double> factors(count, 1);
  for (std::size_t k = 0; k < count; ++k) columns[k] = k;
  if (found) {
    columns = order(found->names, form);
    if (columns.empty()) {
      std::string listed;
      for (const std::string& name : found->names) listed += (listed.empty() ? "" : ", ") + (name.empty() ? "\"\"" : name);
      throw Wrong{found->line, "the names of the columns are " + listed};
    }
    for (std::size_t k = 0; k < columns.size(); ++k) factors[k] = factor(form.columns[k], found->units[columns[k]], found->line, deck);
  } else {
    check_unnamed(content.rows, separator, form);
  }
  std::vector<TableRow> rows;
  for (const Fields& row : content.rows) {
    rows.push_back({row.line, {}, row.marked});
    for (std::size_t k = 0; k < columns.size(); ++k) rows.back().numbers.push_back(factors[k] * number(row.texts[columns[k]]).value());
  }
  return rows;
}

/// Returns the text in UTF-8, with `-` for the minus sign of typography. A text that is not UTF-8 is in Latin-1.
std::string in_utf8(std::string text) {
  int rest = 0;  // number of bytes that continue a character
  for (const unsigned char c : text)
    if ((c & 0xC0) == 0x80 ? --rest < 0 : rest > 0)
      break;
    else if (c >= 0xC0)
      rest = c < 0xE0 ? 1 : c < 0xF0 ? 2 : 3;
  if (rest != 0) {
    std::string wider;
    for (const unsigned char c : text)
      wider += c < 0x80 ? std::string(1, static_cast<char>(c))
                        : std::string{static_cast<char>(c >> 6 | 0xC0), static_cast<char>((c & 0x3F) | 0x80)};
    text = std::move(wider);
  }
  const std::string minus = "\u2212";
  for (std::size_t at = text.find(minus); at != text.npos; at = text.find(minus, at)) text.replace(at, minus.size(), "-");
  return text;
}

}  // namespace

std::vector<TableRow> read_table(const TableFile& file, const std::string& what, const TableForm& form) {
  const std::string text = in_utf8(text_of_file(file.path, what, most_bytes));
  if (text.find('\0') != text.npos)
    throw UserError(what + " is a workbook, another binary file, or text in UTF-16: save the table as CSV in UTF-8.");
  std::vector<Line> lines, notes;
  const std::regex word(form.word.empty() ? "$" : "[\\s,;]\"?" + form.word + "\"?[\\s,;]*$");
  int number = 0;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1)) {
    end = std::min(text.find_first_of("\r\n", begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    const std::size_t note = trimmed(line).starts_with('%') ? line.find('%') : std::min(line.find('#'), line.size());
    const std::string bare = line.substr(0, note);
    ++number;
    if (bare.find_first_not_of(" \t,;") != bare.npos && !bare.starts_with("sep=") && !bare.starts_with("\"sep="))  // Excel's `sep=;`
      lines.push_back({number, std::regex_replace(bare, word, ""), !form.word.empty() && std::regex_search(bare, word)});
    else if (note + 1 < line.size())
      notes.push_back({number, line.substr(note + 1)});
  }
  Texts counts, columns;
  for (const std::size_t count : form.counts) counts.push_back(std::to_string(count));
  for (const TableColumn& column : form.columns) columns.push_back(column.name);
  const std::string expected = "expected are " + joined(counts, " or ") + " columns of numbers, " + joined(columns, ", ") +
                               (form.word.empty() ? "" : ", and where it applies the word `" + form.word + "`") + ".";
  if (lines.empty()) throw UserError(what + " holds no numbers; " + expected);
  const auto present = [&](char one) {
    return std::ranges::any_of(lines, [&](const Line& line) { return trimmed(line.text).find(one) != line.text.npos; });
  };
  std::optional<Content> found;
  Wrong wrong{0, ""};  // mistake with the separator that fits the most lines
  char separator = ' ';
  for (const char one : {';', '\t', ',', ' '}) {
    if (found || !(present(one) || (one == ' ' && wrong.line == 0))) continue;
    try {
      found = content(lines, one);
      separator = one;
    } catch (const Wrong& mistake) {
      if (mistake.line > wrong.line) wrong = mistake, separator = one;
    }
  }
  try {
    if (!found) throw wrong;
    return table(*found, notes, separator, form, file.units.get());
  } catch (const Wrong& mistake) {
    throw UserError(what + formatted(", line %d, ", mistake.line) +
                    (present(separator) ? std::string("columns separated by ") + names_of_separators.at(separator) : "no separator") +
                    ": " + mistake.text + "; " + expected);
  }
}

}  // namespace tanktread::deck
