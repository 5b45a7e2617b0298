#include <cmath>

#include <Teuchos_ParameterList.hpp>

#include "deck/record.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

bool is_dimensional(const Entry& entry) { return !entry.unit.empty() && entry.unit != "1"; }

/// Returns the description of a key with its unit: `rate of the flow [1/time]`.
std::string described(const Entry& entry) { return entry.meaning + (is_dimensional(entry) ? " [" + entry.unit + "]" : ""); }

/// Returns the bounds of a number in the notation of the schema: `, "minimum": 3, "maximum": 200`.
std::string bounds(const Rule& rule) {
  return (std::isfinite(rule.low) ? (rule.open ? ", \"exclusiveMinimum\": " : ", \"minimum\": ") + number_text(rule.low) : "") +
         (std::isfinite(rule.high) ? ", \"maximum\": " + number_text(rule.high) : "");
}

/// Returns the JSON type of a key for the schema. A number with a unit may be a text.
std::string json_type(const Entry& entry) {
  const ValueType& type = entry.type;
  if (type.kind == ValueType::truth) return R"("type": "boolean")";
  if (type.kind == ValueType::text) {
    std::string words;
    for (const std::string& word : type.words) words += (words.empty() ? "" : ", ") + in_quotes(word);
    return words.empty() ? R"("type": "string")" : "\"enum\": [" + words + "]";
  }
  std::string number = R"("type": "number")";
  if (type.kind == ValueType::whole) number = R"("type": "integer")";
  else if (is_dimensional(entry)) number = R"("type": ["number", "string"], "pattern": "^[-−+.0-9]")";
  number += bounds(type.rule);
  if (type.count == 1) return number;
  const std::string size = std::to_string(type.count);
  return R"("type": "array", "items": {)" + number + "}" +
         (type.count ? ", \"minItems\": " + size + ", \"maxItems\": " + size : R"(, "minItems": 1)");
}

std::string key_text(const Entry& entry) {
  const std::string otherwise = entry.fallback.empty() ? "" : "; default " + entry.fallback;
  return in_quotes(entry.key) + ": {" + json_type(entry) + ", \"description\": " + in_quotes(described(entry) + otherwise) + "}";
}

}  // namespace

std::string schema_text(const Record& section, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  std::string properties, others = section.foreign ? "true" : "false";
  const auto add = [&](const std::string& text) { properties += (properties.empty() ? "\n" : ",\n") + indent + "  " + text; };
  for (const Entry& entry : section.entries) add(key_text(entry));
  if (!section.alike)  // otherwise `others` allows these names
    for (const std::string& name : section.mentioned) add(in_quotes(name) + ": true");
  for (const auto& inner : section.sections) {
    if (inner->name != "<name>") add(in_quotes(inner->name) + ": " + schema_text(*inner, depth + 1));
    else others = section.alike ? R"({"type": "object"})" : schema_text(*inner, depth + 1);  // sections that are alike may inherit keys
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
    const std::vector<std::string> texts = as_texts(*section.given->getEntryPtr(entry.key));  // numbers with units stay as they are given
    std::string value = entry.value;
    if (entry.type.kind == ValueType::number && !texts.empty()) value = entry.type.count == 1 ? texts.front() : "[" + joined(texts, ", ") + "]";
    out += indent + "# " + described(entry) + "\n" + indent + entry.key + ": " + value + "\n";
  }
  if (!others.empty()) out += indent + "# and, with their defaults: " + others + "\n";
  for (const auto& inner : section.sections)
    if (inner->given && !inner->foreign) out += indent + inner->name + ":\n" + commented_text(*inner, depth + 1);
  return out;
}

}  // namespace tanktread::deck
