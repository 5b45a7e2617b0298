#include "deck/section.hpp"

#include <algorithm>
#include <cmath>

#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "deck/record.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& must, std::string_view unit, const std::string& given) {
  const std::string in = unit.empty() || unit == "1" ? "" : " (unit: " + std::string(unit) + ")";
  throw UserError(path + " must be " + must + in + ", but is " + given + ".");
}

std::string rule_text(const Rule& rule, const std::string& kind) {
  return rule.text == any().text ? "a " + kind : "a " + kind + ", " + rule.text;
}

/// Powers of a larger number, or of a smaller one, leave the range of double precision.
bool computable(double number) { return std::isfinite(number) && (number == 0 || (std::abs(number) > 1e-75 && std::abs(number) < 1e75)); }

/// Unit of a number whose value the message repeats: checks type, size and rule.
double checked(const std::string& path, const Teuchos::ParameterEntry& entry, const Rule& rule, std::string_view unit) {
  const auto number = as_number(entry);
  if (!number || !std::isfinite(*number) || !rule.holds(*number)) refuse(path, rule_text(rule, "number"), unit, description(entry));
  if (!computable(*number)) refuse(path, "between 1e-75 and 1e75 in size", unit, description(entry));
  return *number;
}

/// How many numbers an array has, in words.
template <int rows, int columns>
constexpr const char* count = rows * columns == 2 ? "two" : rows * columns == 3 ? "three" : "nine";

/// `one number or more`, with the rule of each.
std::string values_text(const std::string& wording, const Rule& each) { return wording + (each.text == any().text ? "" : ", each " + each.text); }

/// Of any count other than zero where `size` is 0; `wording`: what they must be.
std::vector<double> checked_numbers(const std::string& path, const Teuchos::ParameterEntry& entry, std::size_t size, const std::string& wording,
                                    const Rule& each, std::string_view unit) {
  const auto numbers = as_numbers(entry);
  const bool fits = numbers && (size == 0 ? !numbers->empty() : numbers->size() == size);
  bool good = fits;
  if (fits)
    for (const double number : *numbers) good = good && std::isfinite(number) && each.holds(number);
  if (good && !std::all_of(numbers->begin(), numbers->end(), computable))
    refuse(path, "between 1e-75 and 1e75 in size", unit, description(entry));
  if (!good) refuse(path, values_text(wording + " in brackets", each), unit, description(entry));
  return *numbers;
}

template <int rows, int columns>
Eigen::Matrix<double, rows, columns> checked_array(const std::string& path, const Teuchos::ParameterEntry& entry, const Rule& each,
                                                   std::string_view unit) {
  const auto numbers = checked_numbers(path, entry, rows * columns, std::string(count<rows, columns>) + " numbers", each, unit);
  return Eigen::Map<const Eigen::Matrix<double, rows, columns, columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>>(numbers.data());
}

template <int rows, int columns>
std::string array_text(const Eigen::Matrix<double, rows, columns>& values) {
  std::string out = "[";
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) out += (i + j > 0 ? ", " : "") + real_text(values(i, j));
  return out + "]";
}

/// One statement of any type: `read` turns what was given into a value, `write` a value into YAML.
template <class Value, class Field, class Read, class Write>
void state(List& list, std::string_view name, Field& field, const std::string& values, std::string_view unit, std::string_view meaning,
           const Read& read, const Write& write) {
  constexpr bool optional = !std::is_same_v<Field, Value>;
  const auto text = [&]() -> std::string {
    if constexpr (optional)
      return field ? write(*field) : std::string();
    else
      return write(field);
  };
  Entry entry{std::string(name), text(), values, std::string(unit), std::string(meaning), {}};
  const Teuchos::ParameterEntry* given = list.given ? list.given->getEntryPtr(entry.key) : nullptr;
  if (given) field = read(list.path_of(name), *given);
  entry.value = text();
  list.entries.push_back(std::move(entry));
}

template <class Field>
void state_number(List& list, std::string_view name, Field& field, const Rule& rule, std::string_view unit, std::string_view meaning) {
  const auto read = [&](const std::string& path, const Teuchos::ParameterEntry& entry) { return checked(path, entry, rule, unit); };
  state<double>(list, name, field, rule.text, unit, meaning, read, real_text);
}

template <class Field>
void state_whole_number(List& list, std::string_view name, Field& field, const Rule& rule, std::string_view unit,
                        std::string_view meaning) {
  const auto read = [&](const std::string& path, const Teuchos::ParameterEntry& entry) {
    const auto number = as_whole_number(entry);
    if (!number || !rule.holds(*number)) refuse(path, rule_text(rule, "whole number"), unit, description(entry));
    return *number;
  };
  state<int>(list, name, field, "whole, " + rule.text, unit, meaning, read, [](int value) { return std::to_string(value); });
}

template <int rows, int columns, class Field>
void state_array(List& list, std::string_view name, Field& field, const Rule& each, std::string_view unit, std::string_view meaning) {
  const auto read = [&](const std::string& path, const Teuchos::ParameterEntry& entry) {
    return checked_array<rows, columns>(path, entry, each, unit);
  };
  const std::string values = values_text(std::string(count<rows, columns>) + " numbers", each);
  state<Eigen::Matrix<double, rows, columns>>(list, name, field, values, unit, meaning, read, array_text<rows, columns>);
}

template <class Field>
void state_text(List& list, std::string_view name, Field& field, const Choice& choice, std::string_view meaning) {
  const auto read = [&](const std::string& path, const Teuchos::ParameterEntry& entry) {
    const auto text = as_text(entry);
    if (!text && choice.empty()) refuse(path, "text (in quotes)", "", description(entry));
    bool known = choice.empty();
    for (const std::string& word : choice) known = known || (text && word == *text);
    if (known) return *text;
    const std::string meant = text ? guess(*text, choice) : std::string();
    const std::string hint = meant.empty() ? "" : "; was `" + meant + "` meant?";
    throw UserError(path + " must be " + alternatives(choice) + ", but is " + description(entry) + (hint.empty() ? "." : hint));
  };
  const auto write = [](const std::string& text) { return is_plain(text) ? text : in_quotes(text); };
  std::string values;
  for (const std::string& word : choice) values += (values.empty() ? "`" : ", `") + word + "`";
  state<std::string>(list, name, field, choice.empty() ? "text" : values, "", meaning, read, write);
}

}  // namespace

Section::Section(std::shared_ptr<State> state) : state_(std::move(state)) {}

void Section::key(std::string_view name, double& field, const Rule& rule, std::string_view unit, std::string_view meaning) {
  state_number(*state_->list, name, field, rule, unit, meaning);
}

void Section::key(std::string_view name, std::optional<double>& field, const Rule& rule, std::string_view unit, std::string_view meaning) {
  state_number(*state_->list, name, field, rule, unit, meaning);
}

void Section::key(std::string_view name, int& field, const Rule& rule, std::string_view unit, std::string_view meaning) {
  state_whole_number(*state_->list, name, field, rule, unit, meaning);
}

void Section::key(std::string_view name, std::optional<int>& field, const Rule& rule, std::string_view unit, std::string_view meaning) {
  state_whole_number(*state_->list, name, field, rule, unit, meaning);
}

void Section::key(std::string_view name, std::optional<Eigen::Vector2d>& field, const Rule& each, std::string_view unit,
                  std::string_view meaning) {
  state_array<2, 1>(*state_->list, name, field, each, unit, meaning);
}

void Section::key(std::string_view name, Vec3& field, const Rule& each, std::string_view unit, std::string_view meaning) {
  state_array<3, 1>(*state_->list, name, field, each, unit, meaning);
}

void Section::key(std::string_view name, std::optional<Vec3>& field, const Rule& each, std::string_view unit, std::string_view meaning) {
  state_array<3, 1>(*state_->list, name, field, each, unit, meaning);
}

void Section::key(std::string_view name, Mat3& field, const Rule& each, std::string_view unit, std::string_view meaning) {
  state_array<3, 3>(*state_->list, name, field, each, unit, meaning);
}

void Section::key(std::string_view name, std::optional<Mat3>& field, const Rule& each, std::string_view unit, std::string_view meaning) {
  state_array<3, 3>(*state_->list, name, field, each, unit, meaning);
}

void Section::key(std::string_view name, std::optional<std::vector<double>>& field, const Rule& each, std::string_view unit,
                  std::string_view meaning) {
  const std::string wording = "one number or more";
  const auto read = [&](const std::string& path, const Teuchos::ParameterEntry& entry) {
    return checked_numbers(path, entry, 0, wording, each, unit);
  };
  const auto write = [](const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "[" : ", ") + real_text(number);
    return text + "]";
  };
  state<std::vector<double>>(*state_->list, name, field, values_text(wording, each), unit, meaning, read, write);
}

void Section::key(std::string_view name, bool& field, std::string_view meaning) {
  const auto read = [](const std::string& path, const Teuchos::ParameterEntry& entry) {
    const auto truth = as_truth(entry);
    if (!truth) refuse(path, "true or false", "", description(entry));
    return *truth;
  };
  state<bool>(*state_->list, name, field, "true or false", "", meaning, read, [](bool value) { return value ? "true" : "false"; });
}

void Section::key(std::string_view name, std::string& field, const Choice& choice, std::string_view meaning) {
  state_text(*state_->list, name, field, choice, meaning);
}

void Section::key(std::string_view name, std::optional<std::string>& field, const Choice& choice, std::string_view meaning) {
  state_text(*state_->list, name, field, choice, meaning);
}

Section Section::enter(std::string_view name, std::string_view meaning) {
  List& outer = *state_->list;
  auto inner = std::make_unique<List>();
  inner->name = name;
  inner->path = outer.path_of(name);
  inner->meaning = meaning;
  if (const auto* entry = outer.given ? outer.given->getEntryPtr(inner->name) : nullptr) {
    if (!entry->isList()) throw UserError(inner->path + " must be a list of keys, but is " + description(*entry) + ".");
    inner->given = &Teuchos::getValue<Teuchos::ParameterList>(*entry);
  }
  outer.lists.push_back(std::move(inner));
  return Section(std::make_shared<State>(State{outer.lists.back().get(), state_->documenting}));
}

void Section::foreign(std::string_view name, std::shared_ptr<Teuchos::ParameterList>& field, std::string_view meaning) {
  Section inner = enter(name, meaning);
  List& list = *inner.state_->list;
  auto merged = field ? std::make_shared<Teuchos::ParameterList>(*field) : std::make_shared<Teuchos::ParameterList>();
  if (list.given) overlay(*merged, *list.given);
  merged->setName(list.name);
  field = list.foreign = std::move(merged);
}

void Section::mention(std::string_view list) { state_->list->mentioned.emplace_back(list); }

void Section::each(std::string_view meaning, const std::function<void(const std::string& name, Section&)>& use) {
  List& list = *state_->list;
  list.open = true;
  std::vector<std::string> names;
  if (list.given)
    for (const auto& item : *list.given) names.push_back(item.first);
  if (state_->documenting) names = {"<name>"};
  for (const std::string& name : names) {
    Section inner = enter(name, meaning);
    use(name, inner);
  }
}

namespace {

/// The list of this name with all that it shares; `above`: those that lead to it.
std::shared_ptr<Teuchos::ParameterList> with_shared(const List& all, const std::string& name, std::vector<std::string> above) {
  const std::string path = all.path_of(name);
  const auto* entry = all.given->getEntryPtr(name);
  if (!entry->isList()) throw UserError(path + " must be a list of keys, but is " + description(*entry) + ".");
  const auto& own = Teuchos::getValue<Teuchos::ParameterList>(*entry);
  auto merged = std::make_shared<Teuchos::ParameterList>();
  if (const auto* like = own.getEntryPtr("like")) {
    const auto other = as_text(*like);
    above.push_back(name);
    if (!other || !all.given->isSublist(*other) || std::ranges::count(above, *other))
      throw UserError(path + "/like must be the name of another list of " + all.path + " that is not made like this one, but is " +
                      description(*like) + ".");
    merged = with_shared(all, *other, above);
  } else if (all.given->isSublist("defaults")) {
    overlay(*merged, all.given->sublist("defaults"));
  }
  overlay(*merged, own);
  merged->remove("like", false);
  return merged;
}

}  // namespace

void Section::each_alike(std::string_view meaning, const std::function<void(const std::string& name, Section&)>& use) {
  List& list = *state_->list;
  list.open = true;
  list.mentioned.emplace_back("defaults");
  std::vector<std::string> names;
  if (list.given)
    for (const auto& item : *list.given)
      if (item.first != "defaults") names.push_back(item.first);
  if (state_->documenting) names = {"<name>"};
  for (const std::string& name : names) {
    Section inner = enter(name, meaning);
    List& one = *inner.state_->list;
    if (one.given) one.merged = with_shared(list, name, {}), one.given = one.merged.get();
    use(name, inner);
  }
}

bool Section::given(std::string_view name) const { return state_->list->given && state_->list->given->isParameter(std::string(name)); }

bool Section::documenting() const { return state_->documenting; }

std::string Section::path(std::string_view name) const { return name.empty() ? state_->list->path : state_->list->path_of(name); }

}  // namespace tanktread::deck
