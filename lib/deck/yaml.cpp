#include "deck/source.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <vector>

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>
#include <Teuchos_ParameterList.hpp>

#include "base/text_file.hpp"
#include "base/errors.hpp"
#include "deck/words.hpp"
#include "deck/value.hpp"

namespace tanktread::deck {

namespace {

constexpr int most_levels = 20;              // nesting depth of sections
constexpr std::size_t most_nodes = 100'000;  // largest number of keys and values; an alias counts each time it is used
constexpr std::size_t longest_key = 100;     // characters

/// Returns whether the text has the byte patterns of UTF-8.
bool is_utf8(const std::string& text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned c = byte(i);
    int more = c < 0x80 ? 0 : c >> 5 == 6 ? 1 : c >> 4 == 14 ? 2 : c >> 3 == 30 ? 3 : 4;
    if (more == 4) return false;
    for (; more > 0; --more)
      if (byte(++i) >> 6 != 2) return false;
  }
  return true;
}

/// Reads a number, which may have the sign + (std::from_chars accepts only -). Returns false if `text` is not a number.
template <class Number>
bool reads(const std::string& text, Number& number) {
  const char *begin = text.data() + (text.starts_with('+') && !text.starts_with("+-") ? 1 : 0), *end = text.data() + text.size();
  const auto [last, error] = std::from_chars(begin, end, number);
  return error == std::errc() && last == end;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Returns whether a node is a whole number.
bool is_whole(const YAML::Node& node) {
  long long whole = 0;
  return node.IsScalar() && reads(node.Scalar(), whole);
}

/// Converts a word to an entry of the first of these types that fits: truth value, whole number, number, text. A word in quotes is text.
Teuchos::ParameterEntry typed(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  const bool plain = node.Tag() == "?" || node.Tag().empty();
  const bool number = plain && text.find_first_not_of("+-.0123456789eE") == std::string::npos;
  const std::string lower = lower_case(text);
  int whole = 0;
  long long long_whole = 0;
  double real = 0;
  if (plain && (lower == "true" || lower == "yes")) return Teuchos::ParameterEntry(true);
  if (plain && (lower == "false" || lower == "no")) return Teuchos::ParameterEntry(false);
  if (number && reads(text, whole)) return Teuchos::ParameterEntry(whole);
  if (number && reads(text, long_whole)) return Teuchos::ParameterEntry(long_whole);
  if (number && reads(text, real)) return Teuchos::ParameterEntry(real);
  return Teuchos::ParameterEntry(text);
}

template <class Number>
Teuchos::ParameterEntry row(const std::vector<Teuchos::ParameterEntry>& entries) {
  Teuchos::Array<Number> values;
  for (const auto& entry : entries) values.push_back(static_cast<Number>(*as_number(entry)));
  return Teuchos::ParameterEntry(values);
}

/// Converts a sequence of scalars to an array entry of the first of these types that fits all of them: whole numbers, numbers, texts.
Teuchos::ParameterEntry typed_row(const std::vector<YAML::Node>& nodes) {
  std::vector<Teuchos::ParameterEntry> entries;
  for (const YAML::Node& node : nodes) entries.push_back(typed(node));
  if (std::ranges::all_of(entries, [](const auto& entry) { return entry.template isType<int>(); })) return row<int>(entries);
  if (std::ranges::all_of(entries, [](const auto& entry) { return as_number(entry).has_value(); })) return row<double>(entries);
  Teuchos::Array<std::string> words;
  for (const YAML::Node& node : nodes) words.push_back(node.Scalar());
  return Teuchos::ParameterEntry(words);
}

/// Converts a tree of YAML nodes to a parameter list.
class Walk {
 public:
  explicit Walk(const std::string& origin) : origin_(origin) {}

  /// Adds the keys of `map` to `list`. `path` is the path of the list in the deck.
  void read(const YAML::Node& map, const std::string& path, int level, Teuchos::ParameterList& list) {
    std::map<std::string, int> lines;
    std::string last;    // path of the key before
    YAML::Node before;   // value of the key before
    for (const auto& item : map) {
      const YAML::Node key = item.first;
      if (!key.IsScalar() || key.Scalar().empty() || key.Scalar().size() > longest_key)
        refuse(key, "a key is a word of at most " + std::to_string(longest_key) + " characters, followed by a colon");
      check(key);
      const std::string& name = key.Scalar();
      const std::string here = path.empty() ? name : path + "/" + name;
      if (item.second.IsNull() && is_whole(before) && is_digit(name.front())) refuse_comma(key, last, before.Scalar() + "." + name);
      last = here, before.reset(item.second);
      const auto [first, is_new] = lines.emplace(name, key.Mark().line + 1);
      if (!is_new) refuse(key, here + " is set twice; it was first set in line " + std::to_string(first->second));
      add(name, item.second, level == 0 ? "" : here, level, list);
    }
  }

  /// Adds one key and its value to `list`. `path` is the path of the key in the deck.
  void add(const std::string& name, const YAML::Node& value, const std::string& path, int level, Teuchos::ParameterList& list) {
    if (++nodes_ > most_nodes || level > most_levels)
      refuse(value, "sections and sequences are nested more than " + std::to_string(most_levels) + " deep, or hold more than 100,000 values");
    if (value.IsScalar())
      check(value), list.setEntry(name, typed(value));
    else if (value.IsSequence())
      list.setEntry(name, typed_row(words(value, path)));
    else
      read(value, path, level + 1, list.sublist(name));  // a key with nothing after its colon becomes an empty section
  }

 private:
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& what) const {
    throw UserError(origin_ + ", line " + std::to_string(node.Mark().line + 1) + ": " + what + ".");
  }

  [[noreturn]] void refuse_comma(const YAML::Node& node, const std::string& path, const std::string& works) const {
    refuse(node, path + " has a comma, which is no decimal point: write " + works);
  }

  /// Throws UserError if the blanks in a sequence show that every second comma stands for a decimal point, as in `[0,5, 1,0]`.
  void check_commas(const YAML::Node& sequence, const std::string& path) const {
    std::string works;
    bool decimal = sequence.size() > 2 && sequence.size() % 2 == 0;
    for (std::size_t i = 0; decimal && i < sequence.size(); ++i) {
      const YAML::Node one = sequence[i], before = sequence[i > 0 ? i - 1 : 0];
      decimal = one.IsScalar() && !one.Scalar().empty() && (i % 2 == 1 ? is_digit(one.Scalar().front()) : is_whole(one));
      if (decimal && i > 0) decimal = (one.Mark().pos - before.Mark().pos - static_cast<int>(before.Scalar().size()) == 1) == (i % 2 == 1);
      if (decimal) works += (i == 0 ? "" : i % 2 == 1 ? "." : ", ") + one.Scalar();
    }
    if (decimal) refuse_comma(sequence, path, "[" + works + "]");
  }

  void check(const YAML::Node& node) const {
    if (node.IsScalar() && !is_utf8(node.Scalar())) refuse(node, "a word has bytes that are not UTF-8, but a deck is a text file in UTF-8");
  }

  /// Returns the scalars of a sequence, or of a sequence of sequences of equal length (a matrix, row by row).
  std::vector<YAML::Node> words(const YAML::Node& sequence, const std::string& path) {
    check_commas(sequence, path);
    std::vector<YAML::Node> out;
    for (const YAML::Node& item : sequence) {
      const bool row = item.IsSequence() && item.size() > 0 && item.size() == sequence[0].size();
      for (std::size_t i = 0; i < (row ? item.size() : 1); ++i) {
        out.push_back(row ? item[i] : item);
        check(out.back());
        if (!out.back().IsScalar() || ++nodes_ > most_nodes)
          refuse(sequence, !missing_feature(path).empty()
                               ? path + " is not a key of the deck: " + missing_feature(path)
                               : path +
                                     " is a sequence (brackets, or lines with dashes), but a deck has sequences of numbers or words only" +
                                     (out.back().IsMap() ? ": sections with keys have names, such as Particles/<name>" : ""));
      }
    }
    return out;
  }

  std::string origin_;
  std::size_t nodes_ = 0;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

[[noreturn]] void refuse_line(const std::string& origin, std::size_t line, const std::string& what) {
  throw UserError(origin + ", line " + std::to_string(line + 1) + ": " + what + ".");
}

/// Throws UserError for errors that yaml-cpp does not detect: control characters, and a second document, which yaml-cpp ignores.
void check_lines(const std::vector<std::string>& lines, const std::string& origin) {
  bool content = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto no_text = [](unsigned char c) { return (c < 0x20 && c != '\t' && c != '\r') || c == 0x7f; };
    if (std::ranges::any_of(lines[i], no_text)) refuse_line(origin, i, "this line is not text, but a deck is a text file");
    const std::size_t first = lines[i].find_first_not_of(" \t\r");
    const bool marker = lines[i].starts_with("---") || lines[i].starts_with("...");
    if (content && lines[i].starts_with("---"))
      refuse_line(origin, i, "a second document begins here, but a deck is a single YAML document");
    content = content || (first != std::string::npos && lines[i][first] != '#' && lines[i][first] != '%' && !marker);
  }
}

/// Throws UserError with the line at which yaml-cpp stopped, or if this line is blank, with the last line before it that is not blank.
[[noreturn]] void refuse_yaml(const std::vector<std::string>& lines, const std::string& origin, const YAML::Mark& mark,
                              const std::string& reason) {
  std::size_t number = std::min(static_cast<std::size_t>(std::max(mark.line, 0)), lines.size() - 1);
  const auto blank = [](const std::string& line) { return line.find_first_not_of(" \t\r") == std::string::npos; };
  while (number > 0 && blank(lines[number])) --number;
  std::string line = lines[number];
  const std::size_t indentation = std::min(line.find_first_not_of(" \t"), line.size());
  if (line.substr(0, indentation).find('\t') != std::string::npos) refuse_line(origin, number, "indent with spaces, not with tabs");
  line = shortened(line.substr(indentation), 80);
  const std::string what = reason == YAML::ErrorMsg::END_OF_MAP ? "the indentation fits none of the lines above" : reason;
  refuse_line(origin, number, "this is not valid YAML (" + what + "): `" + line + "`");
}

/// Returns the tree of the document from yaml-cpp. Throws UserError if the text is not valid YAML.
YAML::Node document(const std::string& text, const std::string& origin) {
  const std::vector<std::string> lines = lines_of(text);
  check_lines(lines, origin);
  try {
    const YAML::Node root = YAML::Load(text);
    if (root.IsScalar() || root.IsSequence()) refuse_yaml(lines, origin, root.Mark(), "no key followed by a colon");
    return root;
  } catch (const YAML::DeepRecursion&) {
    throw UserError(origin + ": sections are nested more than " + std::to_string(most_levels) + " deep.");
  } catch (const YAML::Exception& error) {
    refuse_yaml(lines, origin, error.mark, error.msg);
  }
}

}  // namespace

std::shared_ptr<Teuchos::ParameterList> yaml_list(const std::string& text, const std::string& origin) {
  Teuchos::ParameterList whole;
  Walk(origin).read(document(text, origin), "", 0, whole);
  return root_list(whole, origin);
}

std::shared_ptr<Teuchos::ParameterList> setting_list(const std::string& setting) {
  const std::string origin = "--set '" + shortened(setting, 80) + "'";
  const std::size_t equals = setting.find('=');
  const auto refuse = [&] { throw UserError(origin + " must be of the form Section/key=value."); };
  if (equals == std::string::npos || equals + 1 == setting.size() || setting.find('\n') != std::string::npos) refuse();
  std::istringstream path(setting.substr(0, equals));
  std::vector<std::string> keys;
  for (std::string key; std::getline(path, key, '/');) keys.push_back(trimmed(key));
  if (!keys.empty() && keys.front() == root_name) keys.erase(keys.begin());
  if (keys.size() < 2 || keys.size() > most_levels || std::ranges::any_of(keys, &std::string::empty)) refuse();
  auto root = std::make_shared<Teuchos::ParameterList>(root_name);
  Teuchos::ParameterList* list = root.get();
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) list = &list->sublist(keys[i]);
  try {
    Walk(origin).add(keys.back(), YAML::Load(setting.substr(equals + 1)), setting.substr(0, equals), static_cast<int>(keys.size()), *list);
  } catch (const YAML::Exception&) {
    throw UserError(origin + ": the value is not valid YAML.");
  }
  return root;
}

}  // namespace tanktread::deck
