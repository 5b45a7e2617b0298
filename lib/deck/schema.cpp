#include <array>
#include <sstream>
#include <string_view>

#include <Teuchos_ParameterList.hpp>

#include "deck/record.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

/// Returns the words of `text` that are enclosed in backticks.
std::vector<std::string> quoted_words(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = text.find('`'); begin != text.npos; begin = text.find('`', begin)) {
    const std::size_t end = text.find('`', begin + 1);
    words.push_back(text.substr(begin + 1, end - begin - 1));
    begin = end + 1;
  }
  return words;
}

/// Returns the bounds of a number in the notation of the schema, `, "minimum": 3, "maximum": 200`. `rule` is the text of a Rule, `between 3 and 200`.
std::string bounds(const std::string& rule) {
  if (rule.find("positive") != rule.npos) return R"(, "exclusiveMinimum": 0)";
  if (rule.find("not negative") != rule.npos) return R"(, "minimum": 0)";
  std::istringstream words(rule);
  std::string low, high;
  for (std::string word; words >> word;) {
    if (word == "least" || word == "between") words >> low;
    if (word == "and") words >> high;
  }
  return (low.empty() ? "" : ", \"minimum\": " + low) + (high.empty() ? "" : ", \"maximum\": " + high);
}

/// Returns the JSON type of a key for the schema, from the description of its values in the manual. A value with a unit may be a text.
std::string type(const std::string& values, const std::string& unit) {
  if (values == "text") return R"("type": "string")";
  if (values == "true or false") return R"("type": "boolean")";
  if (values.starts_with('`')) {
    std::string words;
    for (const std::string& word : quoted_words(values)) words += (words.empty() ? "" : ", ") + in_quotes(word);
    return "\"enum\": [" + words + "]";
  }
  if (values.starts_with("whole")) return R"("type": "integer")" + bounds(values);
  const std::string number = unit.empty() || unit == "1" ? R"("type": "number")" : R"("type": ["number", "string"], "pattern": "^[-+.0-9]")";
  constexpr std::array<std::pair<std::string_view, int>, 4> rows{{{"one number or more", 0}, {"two", 2}, {"three", 3}, {"nine", 9}}};
  for (const auto& [word, count] : rows)
    if (values.starts_with(word)) {
      const std::string size = std::to_string(count);
      return R"("type": "array", "items": {)" + number + bounds(values) + "}" +
             (count ? ", \"minItems\": " + size + ", \"maxItems\": " + size : R"(, "minItems": 1)");
    }
  return number + bounds(values);
}

std::string key_text(const Entry& entry) {
  const std::string unit = entry.unit.empty() || entry.unit == "1" ? "" : " [" + entry.unit + "]";
  const std::string otherwise = entry.fallback.empty() ? "" : "; default " + entry.fallback;
  return in_quotes(entry.key) + ": {" + type(entry.values, entry.unit) + ", \"description\": " + in_quotes(entry.meaning + unit + otherwise) + "}";
}

}  // namespace

std::string schema_text(const Record& section, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  std::string properties, others = section.foreign ? "true" : "false";
  const auto add = [&](const std::string& text) { properties += (properties.empty() ? "\n" : ",\n") + indent + "  " + text; };
  for (const Entry& entry : section.entries) add(key_text(entry));
  const bool shared = !section.mentioned.empty();  // true if inner sections may inherit keys, for example from the section named `defaults`
  for (const auto& inner : section.sections) {
    if (shared)
      others = R"({"type": "object"})";
    else if (inner->name == "<name>")
      others = schema_text(*inner, depth + 1);
    else
      add(in_quotes(inner->name) + ": " + schema_text(*inner, depth + 1));
  }
  return R"({"type": "object", "description": )" + in_quotes(section.meaning) + R"(, "properties": {)" + properties +
         R"(}, "additionalProperties": )" + others + "}";
}

std::string commented_text(const Record& section, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  std::string out, others;
  for (const Entry& entry : section.entries) {
    if (!section.given || !section.given->getEntryPtr(entry.key)) {
      others += (others.empty() ? "" : ", ") + entry.key + (entry.fallback.empty() ? "" : " (" + entry.fallback + ")");
      continue;
    }
    const std::string unit = entry.unit.empty() || entry.unit == "1" ? "" : " [" + entry.unit + "]";
    out += indent + "# " + entry.meaning + unit + "\n" + indent + entry.key + ": " + entry.value + "\n";
  }
  if (!others.empty()) out += indent + "# and, with their defaults: " + others + "\n";
  for (const auto& inner : section.sections)
    if (inner->given && !inner->foreign) out += indent + inner->name + ":\n" + commented_text(*inner, depth + 1);
  return out;
}

}  // namespace tanktread::deck
