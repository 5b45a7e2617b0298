#include "deck/yaml_lines.hpp"

#include <cctype>
#include <map>
#include <sstream>

#include "base/errors.hpp"

namespace tanktread::deck {

namespace {

[[noreturn]] void refuse(const std::string& origin, std::size_t line, const std::string& what) {
  throw UserError(origin + ", line " + std::to_string(line + 1) + ": " + what + ".");
}

std::string encoded(char c) {
  constexpr const char* digits = "0123456789ABCDEF";
  const auto byte = static_cast<unsigned char>(c);
  return {'~', digits[byte / 16], digits[byte % 16]};
}

/// The line up to its comment (a `#` after white space or at the start, outside of quotes), in the reader's alphabet.
std::string without_comment(const std::string& line) {
  std::string out;
  char quote = 0, before = ' ', last_mark = ':';
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool blank = c == ' ' || c == '\t';
    if (!quote && c == '#' && (before == ' ' || before == '\t')) break;
    out += c == '~' || static_cast<unsigned char>(c) >= 0x80 || (quote && c == '#') ? encoded(c) : std::string(1, c);
    const bool escapes =
        quote && i + 1 < line.size() && ((quote == '"' && c == '\\') || (quote == '\'' && c == '\'' && line[i + 1] == '\''));
    if (escapes) {
      out += line[++i];
    } else if (quote && c == quote) {
      quote = 0;
    } else if (!quote && (c == '"' || c == '\'') && std::string(":,[{-").find(last_mark) != std::string::npos) {
      quote = c;
    }
    before = c;
    if (!blank) last_mark = c;
  }
  return out;
}

/// The key that a line begins with, without quotes; empty: none.
std::string key_of(const std::string& line) {
  const std::size_t begin = line.find_first_not_of(' ');
  if (begin == std::string::npos || line[begin] == '-' || line[begin] == '[' || line[begin] == '{') return {};
  std::size_t end = begin;
  if (line[begin] == '"' || line[begin] == '\'') {
    end = line.find(line[begin], begin + 1);
    return end == std::string::npos ? std::string() : line.substr(begin + 1, end - begin - 1);
  }
  for (end = line.find(':', begin); end != std::string::npos; end = line.find(':', end + 1))
    if (end + 1 == line.size() || line[end + 1] == ' ') break;
  if (end == std::string::npos) return {};
  const std::size_t last = line.find_last_not_of(' ', end - 1);
  return line.substr(begin, last + 1 - begin);
}

void check_characters(const std::string& line, const std::string& origin, std::size_t number) {
  for (const char c : line) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\t') refuse(origin, number, "this is not text, so no deck");
  }
}

/// Holds the open lists, by indentation, and the lines where their keys stand.
struct Outline {
  struct Level {
    std::size_t indent;
    std::string path;
    std::map<std::string, std::size_t> keys;
  };
  std::vector<Level> levels;
  std::string last_key;  ///< path of the last key seen, under which a deeper level opens

  void add(const std::string& line, const std::string& origin, std::size_t number) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (levels.empty() || indent > levels.back().indent) levels.push_back({indent, last_key, {}});
    while (indent < levels.back().indent) {
      levels.pop_back();
      if (levels.empty() || indent > levels.back().indent) refuse(origin, number, "the indentation fits none of the lines above");
    }
    const std::string key = key_of(line);
    if (key.empty()) return;
    Level& level = levels.back();
    last_key = level.path.empty() ? key : level.path + "/" + key;
    const auto [first, is_new] = level.keys.emplace(key, number);
    if (!is_new)
      refuse(origin, number,
             last_key.substr(last_key.find('/') + 1) + " is given a second time; it already stands in line " +
                 std::to_string(first->second + 1));
  }
};

bool is_marker(const std::string& line) { return line.rfind("---", 0) == 0 || line.rfind("...", 0) == 0 || line.rfind('%', 0) == 0; }

}  // namespace

std::vector<std::string> clean_lines(const std::string& text, const std::string& origin) {
  std::vector<std::string> lines;
  Outline outline;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t number = lines.size();
    line = without_comment(line);
    line.erase(line.find_last_not_of(" \t\r") + 1);
    check_characters(line, origin, number);
    lines.push_back(line);
    if (line.empty() || is_marker(line)) continue;
    if (line.substr(0, line.find_first_not_of(" \t")).find('\t') != std::string::npos)
      refuse(origin, number, "indent with spaces, not with tabs");
    outline.add(line, origin, number);
  }
  return lines;
}

std::string decoded(const std::string& text) {
  const auto hexadecimal = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool code = text[i] == '~' && i + 2 < text.size() && hexadecimal(text[i + 1]) && hexadecimal(text[i + 2]);
    out += code ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
    if (code) i += 2;
  }
  return out;
}

std::vector<std::string> outermost_keys(const std::vector<std::string>& lines) {
  std::vector<std::string> keys;
  for (const std::string& line : lines)
    if (!line.empty() && line.front() != ' ' && !is_marker(line)) keys.push_back(key_of(line));
  return keys;
}

}  // namespace tanktread::deck
