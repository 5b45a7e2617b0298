#include "deck/value.hpp"

#include <vector>

#include <Teuchos_ParameterList.hpp>
#include <Teuchos_TwoDArray.hpp>

#include "base/errors.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

template <class Type>
const Type* held(const Teuchos::ParameterEntry& entry) {
  return entry.isType<Type>() ? &Teuchos::getValue<Type>(entry) : nullptr;
}

template <class Values>
std::vector<double> doubles(const Values& values) {
  std::vector<double> out;
  for (const auto& value : values) out.push_back(static_cast<double>(value));
  return out;
}

/// Returns an entry as YAML text. The entry may have any type that Teuchos reads from YAML or XML and that a deck may hold.
std::string yaml_value(const Teuchos::ParameterEntry& entry) {
  if (const auto* value = held<double>(entry)) return real_text(*value);
  if (const auto* value = held<int>(entry)) return std::to_string(*value);
  if (const auto* value = held<long long>(entry)) return std::to_string(*value);
  if (const auto number = as_number(entry)) return number_text(*number);
  if (const auto truth = as_truth(entry)) return *truth ? "true" : "false";
  if (const auto text = as_text(entry)) return is_plain(*text) ? *text : in_quotes(*text);
  if (const auto* texts = held<Teuchos::Array<std::string>>(entry)) {
    std::vector<std::string> words;
    for (const auto& text : *texts) words.push_back(in_quotes(text));
    return "[" + joined(words, ", ") + "]";
  }
  const bool real = held<Teuchos::Array<double>>(entry) || held<Teuchos::TwoDArray<double>>(entry);
  std::vector<std::string> words;
  for (const double value : as_numbers(entry).value_or(std::vector<double>{}))
    words.push_back(real ? real_text(value) : number_text(value));
  return "[" + joined(words, ", ") + "]";
}

}  // namespace

std::optional<double> as_number(const Teuchos::ParameterEntry& entry) {
  if (const auto* value = held<double>(entry)) return *value;
  if (const auto* value = held<int>(entry)) return static_cast<double>(*value);
  if (const auto* value = held<long long>(entry)) return static_cast<double>(*value);
  if (const auto* value = held<float>(entry)) return static_cast<double>(*value);
  return std::nullopt;
}

std::optional<bool> as_truth(const Teuchos::ParameterEntry& entry) {
  const auto* value = held<bool>(entry);
  return value ? std::optional(*value) : std::nullopt;
}

std::optional<std::string> as_text(const Teuchos::ParameterEntry& entry) {
  const auto* value = held<std::string>(entry);
  return value ? std::optional(*value) : std::nullopt;
}

std::vector<std::string> as_texts(const Teuchos::ParameterEntry& entry) {
  if (const auto* texts = held<Teuchos::Array<std::string>>(entry)) return texts->toVector();
  const auto text = as_text(entry);
  return text ? std::vector{*text} : std::vector<std::string>();
}

std::optional<std::vector<double>> as_numbers(const Teuchos::ParameterEntry& entry) {
  if (const auto* values = held<Teuchos::Array<double>>(entry)) return doubles(*values);
  if (const auto* values = held<Teuchos::Array<int>>(entry)) return doubles(*values);
  if (const auto* values = held<Teuchos::Array<long long>>(entry)) return doubles(*values);
  if (const auto* values = held<Teuchos::TwoDArray<double>>(entry)) return doubles(values->getDataArray());
  if (const auto* values = held<Teuchos::TwoDArray<int>>(entry)) return doubles(values->getDataArray());
  return std::nullopt;
}

bool same_value(const Teuchos::ParameterEntry& a, const Teuchos::ParameterEntry& b) {
  const auto numbers = [](const auto& entry) -> std::optional<std::vector<double>> {
    const auto number = as_number(entry);
    return number ? std::vector<double>{*number} : as_numbers(entry);
  };
  if (numbers(a)) return numbers(a) == numbers(b);
  return a.isList() == b.isList() && (a.isList() || yaml_value(a) == yaml_value(b));
}

std::string description(const Teuchos::ParameterEntry& entry) {
  if (entry.isList()) return Teuchos::getValue<Teuchos::ParameterList>(entry).numParams() > 0 ? "a section of keys" : "nothing";
  if (const auto text = as_text(entry)) return in_quotes(shortened(*text, 80)) + " (text)";
  if (const auto* texts = held<Teuchos::Array<std::string>>(entry); texts && texts->size() > 12)
    return std::to_string(texts->size()) + " words";
  if (const auto numbers = as_numbers(entry); numbers && numbers->size() > 12) return std::to_string(numbers->size()) + " numbers";
  if (const auto* value = held<double>(entry)) return number_text(*value);
  return yaml_value(entry);
}

std::string yaml_text(const Teuchos::ParameterList& list, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  std::string out;
  for (const auto& item : list) {
    const std::string& name = item.first;
    const Teuchos::ParameterEntry& entry = item.second;
    const std::string key = indent + (is_plain(name) ? name : in_quotes(name)) + ":";
    if (!entry.isList()) {
      out += key + " " + yaml_value(entry) + "\n";
      continue;
    }
    const std::string inner = yaml_text(Teuchos::getValue<Teuchos::ParameterList>(entry), depth + 1);
    out += key + (inner.empty() ? " {}\n" : "\n" + inner);
  }
  return out;
}

void overlay(Teuchos::ParameterList& base, const Teuchos::ParameterList& over) {
  for (const auto& item : over) {
    const std::string& name = item.first;
    const Teuchos::ParameterEntry& entry = item.second;
    if (entry.isList()) {
      if (base.isParameter(name) && !base.isSublist(name)) base.remove(name);
      overlay(base.sublist(name), Teuchos::getValue<Teuchos::ParameterList>(entry));
    } else {
      base.setEntry(name, entry);
    }
  }
}

namespace {

/// Returns the type of an entry in words; empty if no deck can hold this type.
std::string kind(const Teuchos::ParameterEntry& entry) {
  if (entry.isList()) return "a section of keys";
  if (entry.isType<double>()) return "a number with a point";
  if (entry.isType<int>()) return "a whole number";
  if (entry.isType<bool>()) return "true or false";
  if (entry.isType<std::string>()) return "text";
  return {};
}

}  // namespace

void check_foreign(const std::string& path, const Teuchos::ParameterList& given, const Teuchos::ParameterList& valid) {
  for (const auto& item : given) {
    const std::string here = path + "/" + item.first;
    const Teuchos::ParameterEntry* known = valid.getEntryPtr(item.first);
    if (!known) {
      std::vector<std::string> names;
      for (const auto& other : valid) names.push_back(other.first);
      const std::string meant = guess(item.first, names);
      throw UserError(here + " is not a parameter of the library that receives this section" +
                      (meant.empty() ? "." : "; was " + path + "/" + meant + " meant?"));
    }
    const std::string wanted = kind(*known);
    if (wanted.empty()) throw UserError(here + " is a parameter of a type that a deck cannot contain.");
    if (wanted != kind(item.second)) throw UserError(here + " must be " + wanted + ", but is " + description(item.second) + ".");
    if (item.second.isList())
      check_foreign(here, Teuchos::getValue<Teuchos::ParameterList>(item.second), Teuchos::getValue<Teuchos::ParameterList>(*known));
  }
}

}  // namespace tanktread::deck
