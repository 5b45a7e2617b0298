#pragma once
// Registry of user-defined parts of a scene (loads, fields, flows, media, series, equations), which decks choose by name.

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/columns.hpp"
#include "base/errors.hpp"
#include "deck/section.hpp"

namespace tanktread::deck {

template <class Signature>
class Parts;

/// Registered parts of one kind, for example loads. A registered function makes a part (type `Made`) from arguments `On...`, for example the surface
/// on which a load acts. If a deck uses a part, it has a section with the name of the part, which holds the keys of the part.
template <class Made, class... On>
class Parts<Made(On...)> {
 public:
  using Maker = std::function<Made(On...)>;
  struct Chosen {
    std::string name;
    Maker make;
    std::vector<Column> columns;  ///< columns that the part adds to the record of a run

    /// Adds the columns and their values to a row. Throws std::logic_error if the number of values differs from the number of columns.
    void add_columns(const std::vector<double>& values, Columns& to) const {
      if (values.size() != columns.size()) throw std::logic_error(name + " gives another number of values than it has columns");
      for (std::size_t k = 0; k < values.size(); ++k) to.add(values[k], columns[k]);
    }
    /// Adds the columns with value 0. Used if only the column names are needed.
    void add_columns(Columns& to) const { add_columns(std::vector<double>(columns.size(), 0.), to); }
  };

  /// Registers a part. `Options` is a struct with default values and a function `declare(Section&)`, which declares its keys.
  /// `make(options, on...)` makes the part. `columns` are the columns that it adds to the record of a run.
  /// Throws std::invalid_argument if the name is already registered.
  template <class Options, class Make>
  void add(const std::string& name, std::string meaning, Make make, std::vector<Column> columns = {}) {
    if (std::ranges::count(all_, name, &Part::name) > 0) throw std::invalid_argument("two parts have the name " + name);
    all_.push_back({name, std::move(meaning), [make](Section& section) -> Maker {
                      Options options;
                      options.declare(section);
                      return [make, options](On... on) { return Made(make(options, std::forward<On>(on)...)); };
                    },
                    std::move(columns)});
  }

  bool empty() const { return all_.empty(); }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Part& part : all_) names.push_back(part.name);
    return names;
  }

  /// Returns the columns that all registered parts add to the record of a run, for the manual.
  std::vector<Column> columns() const {
    std::vector<Column> all;
    for (const Part& part : all_) all.insert(all.end(), part.columns.begin(), part.columns.end());
    return all;
  }

  /// Returns the parts for which the deck has a section inside `section`, in the order of registration.
  std::vector<Chosen> read(Section& section) const {
    std::vector<Chosen> chosen;
    for (const Part& part : all_) {
      Reader reader{part, {}};
      if (section.optional_section(part.name, reader, part.meaning)) chosen.push_back({part.name, std::move(reader.make), part.columns});
    }
    return chosen;
  }

  /// Returns the registered parts that the deck uses: the parts with a section in the section `name` of `outer`. Declares the section `name` only if
  /// parts are registered.
  std::vector<Chosen> read(Section& outer, const char* name, const char* meaning) const {
    struct List {
      const Parts& parts;
      std::vector<Chosen> chosen;
      void declare(Section& section) { chosen = parts.read(section); }
    } list{*this, {}};
    if (!all_.empty()) outer.optional_section(name, list, meaning);
    return std::move(list.chosen);
  }

  /// Returns the function that makes the part `chosen`, with the options that the deck sets in the section of this part, or with default options if
  /// this section is missing. Returns an empty function if no part has this name. `key`: key of `section` whose value is `chosen`. Throws UserError
  /// if the deck has a section of another part.
  Maker read(Section& section, const std::string& chosen, const char* key) const {
    Maker make;
    for (const Part& part : all_) {
      if (part.name != chosen && section.given(part.name))
        throw UserError(section.path(part.name) + " belongs to " + section.path(key) + " `" + part.name + "`, but " + section.path(key) + " is `" +
                        chosen + "`.");
      if (part.name != chosen && !section.documenting()) continue;
      Reader reader{part, {}};
      section.section(part.name, reader, part.meaning);
      if (part.name == chosen) make = std::move(reader.make);
    }
    return make;
  }

 private:
  struct Part {
    std::string name, meaning;
    std::function<Maker(Section&)> read;
    std::vector<Column> columns;
  };
  struct Reader {
    const Part& part;
    Maker make;
    void declare(Section& section) { make = part.read(section); }
  };
  std::vector<Part> all_;
};

}  // namespace tanktread::deck
