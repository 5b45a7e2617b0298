#include "deck/quantity.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <regex>
#include <string_view>
#include <utility>

#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

/// Returns the text with characters beyond ASCII replaced: `µm s⁻¹` becomes `um s^-1`. Characters that are not in the table stay.
std::string in_ascii(const std::string& text) {
  constexpr std::pair<std::string_view, std::string_view> table[] = {
      {"\u2212", "-"}, {"\u2013", "-"}, {"\u00b5", "u"}, {"\u03bc", "u"}, {"\u00b7", "*"}, {"\u22c5", "*"}, {"\u2219", "*"},
      {"\u2022", "*"}, {"\u00d7", "*"}, {"\u2215", "/"}, {"\u2044", "/"}, {"\u00a0", " "}, {"\u2009", " "}, {"\u202f", " "},
      {"\u00c5", "angstrom"}, {"\u212b", "angstrom"}, {"\u00b0", "degree"}, {"\u00ba", "degree"},
      {"\u207b", "^-"}, {"\u2070", "^0"}, {"\u00b9", "^1"}, {"\u00b2", "^2"}, {"\u00b3", "^3"}, {"\u2074", "^4"},
      {"\u2075", "^5"}, {"\u2076", "^6"}, {"\u2077", "^7"}, {"\u2078", "^8"}, {"\u2079", "^9"}};
  std::string out;
  bool raised = false;  // whether the last character was a superscript
  for (std::size_t at = 0; at < text.size();) {
    const auto* found = std::ranges::find_if(table, [&](const auto& one) { return text.compare(at, one.first.size(), one.first) == 0; });
    if (found == std::end(table)) {
      out += text[at++], raised = false;
      continue;
    }
    const bool again = std::exchange(raised, found->second.front() == '^') && raised;
    out += found->second.substr(again ? 1 : 0), at += found->first.size();
  }
  return out;
}

constexpr std::size_t longest = 200;  // bytes of a text that may be a quantity; the regular expressions of the standard library recurse

using Rules = std::vector<std::pair<std::regex, std::string>>;

std::string rewritten(std::string text, const Rules& rules) {
  for (const auto& [pattern, replacement] : rules) text = std::regex_replace(text, pattern, replacement);
  return text;
}

}  // namespace

std::optional<Quantity> quantity(const std::string& text) {
  static const Rules powers_of_ten{{std::regex(R"(\*\*)"), "^"},
                                   {std::regex(R"(^([-+]?[0-9.]+)(?: ?[x*] ?| )10(?:\^([-+]?\d+)|([-+]\d+)))"), "$1e$2$3"},
                                   {std::regex(R"(^([-+]?)10\^([-+]?\d+))"), "$011e$2"},
                                   {std::regex(R"(^\+(?=[0-9.]))"), ""}};
  static const Rules units{{std::regex(R"(\^[({]([-+]?\d+)[)}])"), "^$1"},
                           {std::regex(R"(\bper\b)"), "/"},
                           {std::regex(R"(\s*([*/.])\s*)"), "$1"},
                           {std::regex(R"(^\s+|\s+$)"), ""},
                           {std::regex(R"(\s+)"), " "},
                           {std::regex(R"(^/)"), "1/"},
                           {std::regex(R"( ?H2O\b)"), " water"},
                           {std::regex(R"(\b([kmu]?Pa|[kmunpf]?N)([cmunp]?m|[mu]?s)\b)"), "$1 $2"}};
  if (text.size() > longest) return std::nullopt;
  const std::string plain = rewritten(in_ascii(text), powers_of_ten);
  double number = 0;
  const auto [rest, error] = std::from_chars(plain.data(), plain.data() + plain.size(), number);
  if (error != std::errc()) return std::nullopt;
  return Quantity{number, rewritten({rest, plain.data() + plain.size()}, units)};
}

bool is_product_of_words(const std::string& unit) {
  static const std::regex product([] {
    const std::string factor = R"(\(*[A-Za-z_%]+(\^?[-+]?\d+)?\)*(\^[-+]?\d+)?)";
    return "(1/)?" + factor + "([ */.-]" + factor + ")*";
  }());
  return std::regex_match(unit, product);
}

std::string working_spelling(const std::string& text) {
  if (text.size() > longest) return {};
  static const std::regex before(R"(^(?:[^-+.\w]+|[A-Za-z]+\.? ))"), separated(R"(([-+]?\d+)((?:[,' ]\d+)+)((?:\.\d+)?)(|[^-+,'.\d].*))");
  std::smatch parts;
  const std::string ascii = in_ascii(text), plain = std::regex_replace(ascii, before, "");
  std::vector<std::string> works;
  if (std::regex_match(plain, parts, separated)) {
    const std::string first = parts[1], rest = parts[3].str() + parts[4].str();
    std::string digits = parts[2];
    if (digits.front() == ',' && digits.find_first_of(",' ", 1) == digits.npos && !parts[3].length())
      works.push_back(first + "." + digits.substr(1) + rest);
    const bool thousands = std::regex_match(first + digits, std::regex("[-+]?[1-9]\\d{0,2}([,' ]\\d{3})+"));
    std::erase_if(digits, [](char c) { return !std::isdigit(static_cast<unsigned char>(c)); });
    if (thousands) works.push_back(first + digits + rest);
  } else if (const auto value = quantity(plain); value && (value->unit.empty() || plain != ascii)) {
    works = {value->unit.empty() ? number_text(value->number) : plain};
  }
  return works.empty() || works.front() == text ? "" : "; write " + alternatives(works);
}

}  // namespace tanktread::deck
