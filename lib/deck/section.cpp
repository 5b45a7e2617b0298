#include "deck/section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "deck/quantity.hpp"
#include "deck/record.hpp"
#include "deck/units.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& must, std::string_view unit, const std::string& given) {
  const std::string in = unit.empty() || unit == "1" ? "" : " (unit: " + std::string(unit) + ")";
  throw UserError(path + " must be " + must + in + ", but is " + given + ".");
}

/// Returns whether the number is 0, or finite and of moderate size, so that its powers do not overflow or underflow.
bool computable(double number) { return std::isfinite(number) && (number == 0 || (std::abs(number) > 1e-75 && std::abs(number) < 1e75)); }

/// Returns the type of a value that consists of one number or several.
template <class Value>
ValueType type_of(const Rule& rule) {
  if constexpr (std::is_arithmetic_v<Value>) return {std::is_same_v<Value, int> ? ValueType::whole : ValueType::number, rule};
  else if constexpr (std::is_same_v<Value, std::vector<double>>) return {ValueType::number, rule, 0};
  else {
    constexpr int count = Value::SizeAtCompileTime;
    static_assert(count > 1 && !numbers_in_words.at(count).empty(), "numbers_in_words needs words for this size");
    return {ValueType::number, rule, count};
  }
}

/// Returns a value from its numbers; the numbers of a matrix are given row by row.
template <class Value>
Value value_of(const std::vector<double>& numbers) {
  if constexpr (std::is_arithmetic_v<Value>) return static_cast<Value>(numbers.front());
  else if constexpr (std::is_same_v<Value, std::vector<double>>) return numbers;
  else return Eigen::Map<const Eigen::Matrix<double, Value::ColsAtCompileTime, Value::RowsAtCompileTime>>(numbers.data()).transpose();
}

/// Returns whether a text begins with a number followed by other characters, such as a unit, but not by a comma, as in a list without brackets, or
/// by digits, as in `1 000`.
bool has_unit(const std::string& text) {
  const std::optional<Quantity> given = quantity(text);
  if (!given || given->unit.empty()) return false;
  const char first = given->unit.front();
  return first != ',' && (!std::isdigit(static_cast<unsigned char>(first)) || given->unit.starts_with("1/"));
}

/// Returns the end of a sentence about a refused value of `size` numbers: the spelling of a number that works, if the deck has another one.
std::string spelling_of_numbers(const Teuchos::ParameterEntry& entry, int size) {
  const std::vector<std::string> texts = as_texts(entry);
  for (const std::string& text : texts)
    if (const std::string works = working_spelling(text); !works.empty()) return works;
  const std::size_t given = std::max(texts.size(), as_numbers(entry).value_or(std::vector<double>()).size());
  return size > 1 && static_cast<int>(given) > size ? "; if commas are meant as decimal points, write points: [0.5, 1.0, 1.5]" : "";
}

/// Returns the numbers of an entry, converted to the deck's units, if at least one of them has a unit; otherwise an empty vector. Throws UserError if
/// a unit is wrong or the deck has no section Units.
std::vector<double> numbers_with_units(const std::string& path, const Teuchos::ParameterEntry& entry, std::string_view unit, const Units* units) {
  const std::vector<std::string> texts = as_texts(entry);
  if (std::ranges::none_of(texts, has_unit)) return {};
  if (!units) refuse(path, "a plain number in a deck without the section Units", unit, description(entry) + "; with `Units: {}` units work");
  std::vector<double> numbers;
  for (const std::string& text : texts) try {
      numbers.push_back(units->number(text, unit));
    } catch (const std::invalid_argument& error) {
      const char* must = error.what() == Units::plain ? "a plain number" : "a number with a unit";
      refuse(path, must, unit, in_quotes(shortened(text, 80)) + ", which " + error.what());
    }
  return numbers;
}

/// Returns the numbers of an entry; the numbers of a matrix are given row by row. Throws UserError if the entry does not have the type `type`.
std::vector<double> checked(const std::string& path, const Teuchos::ParameterEntry& entry, const ValueType& type, std::string_view unit,
                            const Units* units) {
  const bool whole = type.kind == ValueType::whole, single = type.count == 1;
  std::vector<double> numbers;
  if (!whole) numbers = numbers_with_units(path, entry, unit, units);
  if (!single) numbers = as_numbers(entry).value_or(numbers);
  else if (const auto number = as_number(entry)) numbers = {*number};
  bool good = type.count == 0 ? !numbers.empty() : std::ssize(numbers) == type.count;
  if (single) good = good && (as_number(entry) || as_text(entry));
  for (const double x : numbers)
    good = good && std::isfinite(x) && type.rule.holds(x) && (!whole || (x == std::floor(x) && std::abs(x) <= std::numeric_limits<int>::max()));
  if (!good) refuse(path, numbers_text(type, " in brackets"), unit, description(entry) + spelling_of_numbers(entry, type.count));
  if (!whole && !std::ranges::all_of(numbers, computable)) refuse(path, "between 1e-75 and 1e75 in size", unit, description(entry));
  return numbers;
}

/// Returns a value as YAML text.
std::string yaml(double value) { return real_text(value); }
std::string yaml(int value) { return std::to_string(value); }
std::string yaml(bool value) { return value ? "true" : "false"; }
std::string yaml(const std::string& text) { return is_plain(text) ? text : in_quotes(text); }
std::string yaml(const std::vector<double>& numbers) {
  std::vector<std::string> words;
  for (const double number : numbers) words.push_back(real_text(number));
  return "[" + joined(words, ", ") + "]";
}
template <int rows, int columns>
std::string yaml(const Eigen::Matrix<double, rows, columns>& values) {
  const Eigen::Matrix<double, columns, rows> by_rows = values.transpose();
  return yaml(std::vector<double>(by_rows.data(), by_rows.data() + by_rows.size()));
}

/// Value type and YAML text of an options field, which may be std::optional.
template <class Field>
struct Held {
  using Value = Field;
  static std::string text(const Field& field) { return yaml(field); }
};
template <class Field>
struct Held<std::optional<Field>> {
  using Value = Field;
  static std::string text(const std::optional<Field>& field) { return field ? yaml(*field) : std::string(); }
};

/// Records the declaration of a key of any type. `read` converts the given entry to a value; if it throws UserError, the field keeps its default.
template <class Field, class Read>
void state(Record& record, std::string_view name, Field& field, const ValueType& type, std::string_view unit, std::string_view meaning,
           const Read& read) {
  Entry entry{std::string(name), Held<Field>::text(field), type, std::string(unit), std::string(meaning), {}};
  if (const Teuchos::ParameterEntry* given = record.given ? record.given->getEntryPtr(entry.key) : nullptr) try {
      field = read(record.path_of(name), *given);
    } catch (const UserError& error) {
      record.mistakes.emplace_back(error.what());
    }
  entry.value = Held<Field>::text(field);
  record.entries.push_back(std::move(entry));
}

/// Records a sentence about the largest of a key's numbers if its size is unusual. Leaves out the lengths of Adaptation, which are tolerances.
void note_unusual(Record& record, const Units& units, const std::string& path, const std::vector<double>& numbers, const Rule& rule,
                  std::string_view unit) {
  const double size = std::abs(std::ranges::max(numbers, {}, [](double x) { return std::abs(x); }));
  const std::string how = record.name == "Adaptation" ? "" : units.unusual(unit, size, rule.low < 0 && unit == "length");
  if (!how.empty()) record.unusual.push_back(path + " " + how + ".");
}

/// Returns the section of this name, completed by the keys of the section that its key `like` names. Without the key `like`, it is completed by the
/// keys of the section `defaults`, if there is one. `above`: names of the sections whose `like` led to this section, to detect a cycle.
std::shared_ptr<Teuchos::ParameterList> with_shared(const Record& all, const std::string& name, std::vector<std::string> above) {
  const std::string path = all.path_of(name);
  const auto* entry = all.given->getEntryPtr(name);
  if (!entry->isList()) throw UserError(path + " must be a section of keys, but is " + description(*entry) + ".");
  const auto& own = Teuchos::getValue<Teuchos::ParameterList>(*entry);
  auto merged = std::make_shared<Teuchos::ParameterList>();
  if (const auto* like = own.getEntryPtr("like")) {
    const auto other = as_text(*like);
    above.push_back(name);
    if (!other || !all.given->isSublist(*other) || std::ranges::count(above, *other))
      throw UserError(path + "/like must be the name of another section of " + all.path +
                      " whose own `like` does not lead back to this one, but is " + description(*like) + ".");
    merged = with_shared(all, *other, above);
  } else if (all.given->isSublist("defaults")) {
    overlay(*merged, all.given->sublist("defaults"));
  }
  overlay(*merged, own);
  merged->remove("like", false);
  return merged;
}

}  // namespace

Rule any() { return {.text = "any number"}; }
Rule positive() { return {.text = "positive", .low = 0, .open = true}; }
Rule not_negative() { return {.text = "not negative", .low = 0}; }
Rule at_least(double low) { return {.text = "at least " + number_text(low), .low = low}; }
Rule between(double low, double high) { return {.text = "between " + number_text(low) + " and " + number_text(high), .low = low, .high = high}; }

Section::Section(std::shared_ptr<State> state) : state_(std::move(state)) {}

template <class Field>
void Section::key(std::string_view name, Field& field, const Rule& rule, std::string_view unit, std::string_view meaning) {
  using Value = typename Held<Field>::Value;
  const ValueType type = type_of<Value>(rule);
  state(*state_->record, name, field, type, unit, meaning,
        [&](const std::string& path, const auto& entry) {
          const std::vector<double> numbers = checked(path, entry, type, unit, state_->units.get());
          if (state_->units) note_unusual(*state_->record, *state_->units, path, numbers, rule, unit);
          return value_of<Value>(numbers);
        });
}

template void Section::key(std::string_view, double&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, std::optional<double>&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, int&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, std::optional<int>&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, std::optional<Eigen::Vector2d>&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, Vec3&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, std::optional<Vec3>&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, Mat3&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, std::optional<Mat3>&, const Rule&, std::string_view, std::string_view);
template void Section::key(std::string_view, std::optional<std::vector<double>>&, const Rule&, std::string_view, std::string_view);

void Section::key(std::string_view name, bool& field, std::string_view meaning) {
  state(*state_->record, name, field, {ValueType::truth}, "", meaning, [](const std::string& path, const Teuchos::ParameterEntry& entry) {
    const auto truth = as_truth(entry);
    if (!truth) refuse(path, "true or false", "", description(entry));
    return *truth;
  });
}

void Section::key(std::string_view name, std::optional<TableFile>& field, std::string_view meaning) {
  std::optional<std::string> path;
  if (field) path = field->path;
  key(name, path, Choice{}, meaning);
  if (path) field = {*path, state_->units};
}

template <class Field>
void Section::key(std::string_view name, Field& field, const Choice& choice, std::string_view meaning) {
  state(*state_->record, name, field, {ValueType::text, {}, 1, choice}, "", meaning,
        [&](const std::string& path, const Teuchos::ParameterEntry& entry) {
          const auto text = as_text(entry);
          if (!text && choice.empty()) refuse(path, "text (in quotes)", "", description(entry));
          if (text && (choice.empty() || std::ranges::count(choice, *text) > 0)) return *text;
          const std::string meant = text ? guess(*text, choice) : std::string();
          throw UserError(path + " must be " + alternatives(choice) + ", but is " + description(entry) +
                          (meant.empty() ? "." : "; was `" + meant + "` meant?"));
        });
}

template void Section::key(std::string_view, std::string&, const Choice&, std::string_view);
template void Section::key(std::string_view, std::optional<std::string>&, const Choice&, std::string_view);

void Section::without_effect(const std::vector<std::string>& names, const std::string& because) {
  Record& record = *state_->record;
  for (const Entry& entry : record.entries)
    if (std::ranges::count(names, entry.key) > 0 && entry.value != entry.fallback)
      record.idle.push_back(record.path_of(entry.key) + " has no effect " + because + ": remove the key.");
}

void Section::without_effect_except(const std::string& name, const std::string& because) {
  std::vector<std::string> others;
  for (const Entry& entry : state_->record->entries)
    if (entry.key != name) others.push_back(entry.key);
  without_effect(others, because);
}

std::vector<std::string> Section::idle_keys() const { return deck::idle_keys(*state_->record); }
std::vector<std::string> Section::unusual_values() const { return deck::unusual_values(*state_->record); }

Section Section::enter(std::string_view name, std::string_view meaning) {
  Record& outer = *state_->record;
  auto inner = std::make_unique<Record>();
  inner->name = name;
  inner->path = outer.path_of(name);
  inner->meaning = meaning;
  if (const auto* entry = outer.given ? outer.given->getEntryPtr(inner->name) : nullptr) {
    if (entry->isList())
      inner->given = &Teuchos::getValue<Teuchos::ParameterList>(*entry);
    else
      outer.mistakes.push_back(inner->path + " must be a section of keys, but is " + description(*entry) + ".");
  }
  outer.sections.push_back(std::move(inner));
  return Section(std::make_shared<State>(State{outer.sections.back().get(), state_->documenting, state_->units}));
}

void Section::foreign(std::string_view name, std::shared_ptr<Teuchos::ParameterList>& field, std::string_view meaning) {
  Section inner = enter(name, meaning);
  Record& record = *inner.state_->record;
  auto merged = field ? std::make_shared<Teuchos::ParameterList>(*field) : std::make_shared<Teuchos::ParameterList>();
  if (record.given) overlay(*merged, *record.given);
  merged->setName(record.name);
  field = record.foreign = std::move(merged);
}

void Section::take(std::shared_ptr<const Units> units) { state_->units = std::move(units); }

void Section::mention(std::string_view name) { state_->record->mentioned.emplace_back(name); }

void Section::each(std::string_view meaning, const std::function<void(const std::string& name, Section&)>& use, bool alike) {
  Record& record = *state_->record;
  record.alike = alike;
  if (alike) record.mentioned.emplace_back("defaults");
  std::vector<std::string> names;
  if (record.given)
    for (const auto& item : *record.given)
      if (!alike || item.first != "defaults") names.push_back(item.first);
  if (state_->documenting) names = {"<name>"};
  for (const std::string& name : names) {
    Section inner = enter(name, meaning);
    Record& one = *inner.state_->record;
    one.itself = one.given;
    if (alike && one.given) one.merged = with_shared(record, name, {}), one.given = one.merged.get();
    use(name, inner);
  }
}

bool Section::given(std::string_view name) const { return state_->record->given && state_->record->given->isParameter(std::string(name)); }

void Section::leave_out(std::string_view name) {
  Record& record = *state_->record;
  if (record.merged && !record.itself->isParameter(std::string(name))) record.merged->remove(std::string(name), false);
}

bool Section::documenting() const { return state_->documenting; }

std::string Section::path(std::string_view name) const { return name.empty() ? state_->record->path : state_->record->path_of(name); }

}  // namespace tanktread::deck
