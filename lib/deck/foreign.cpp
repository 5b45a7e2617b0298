#include "deck/foreign.hpp"

#include <vector>

#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

/// What an entry holds, in words; empty: something that no deck can hold.
std::string kind(const Teuchos::ParameterEntry& entry) {
  if (entry.isList()) return "a list of keys";
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
      throw UserError(here + " is not a parameter of the library that gets this list" +
                      (meant.empty() ? "." : "; was " + path + "/" + meant + " meant?"));
    }
    const std::string wanted = kind(*known);
    if (wanted.empty()) throw UserError(here + " is a parameter that no deck can hold.");
    if (wanted != kind(item.second)) throw UserError(here + " must be " + wanted + ", but is " + description(item.second) + ".");
    if (item.second.isList())
      check_foreign(here, Teuchos::getValue<Teuchos::ParameterList>(item.second), Teuchos::getValue<Teuchos::ParameterList>(*known));
  }
}

}  // namespace tanktread::deck
