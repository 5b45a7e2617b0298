#include "deck/words.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace tanktread::deck {

std::string number_text(double value) {
  char digits[40];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return {digits, end};
}

std::string real_text(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  std::string text = number_text(value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    constexpr const char* digits = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += '\\';
    if (byte < 0x20 || byte == 0x7f)
      out += {'\\', 'x', digits[byte / 16], digits[byte % 16]};
    else
      out += c;
  }
  return out + "\"";
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_plain(const std::string& text) {
  if (text.empty() || !std::isalpha(static_cast<unsigned char>(text.front())) || text.back() == ' ') return false;
  if (!std::ranges::all_of(text, [](unsigned char c) { return std::isalnum(c) || c == ' ' || c == '-' || c == '_'; })) return false;
  constexpr const char* others[] = {"true", "false", "yes", "no", "on", "off", "y", "n", "null", "nan", "inf", "infinity"};
  return std::ranges::count(others, lower_case(text)) == 0;
}

std::string shortened(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // moves the cut so that it does not split a UTF-8 character
  return text.substr(0, end) + "...";
}

std::string alternatives(const std::vector<std::string>& words) { return joined(words, " or "); }

std::string joined(const std::vector<std::string>& words, const std::string& last_link) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += i + 1 == words.size() ? last_link : ", ";
    out += words[i];
  }
  return out;
}

namespace {

/// Returns the optimal string alignment distance: the number of insertions, deletions, replacements and swaps of neighbours that turn a into b.
int edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string guess(const std::string& given, const std::vector<std::string>& candidates) {
  if (given.size() > 200) return {};
  std::string best;
  int smallest = std::max(1, static_cast<int>(given.size()) / 3) + 1;
  for (const std::string& candidate : candidates) {
    const int distance = edit_distance(lower_case(given), lower_case(candidate));
    if (distance < smallest) {
      smallest = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace tanktread::deck
