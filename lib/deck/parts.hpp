#pragma once
// Parts of a scene that a program adds to those of the library, by names that decks use.

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/columns.hpp"
#include "deck/section.hpp"

namespace tanktread::deck {

template <class Signature>
class Parts;

/// Parts of one kind, made for what they are on. The deck has a section with the name of each part that it uses, and the part's own keys in it.
template <class Made, class... On>
class Parts<Made(On...)> {
 public:
  using Maker = std::function<Made(On...)>;
  struct Chosen {
    std::string name;
    Maker make;
    std::vector<Column> columns;  ///< with which it is registered

    /// Adds its columns to a row. Throws std::logic_error if there are more or fewer values.
    void add_columns(const std::vector<double>& values, Columns& to) const {
      if (values.size() != columns.size()) throw std::logic_error(name + " gives another number of values than it has columns");
      for (std::size_t k = 0; k < values.size(); ++k) to.add(values[k], columns[k]);
    }
    /// Adds them without values, for their names.
    void add_columns(Columns& to) const { add_columns(std::vector<double>(columns.size(), 0.), to); }
  };

  /// Adds a part. `Options`: a struct with default values and `declare(Section&)`, which states its keys; `make(options, on...)` makes the part;
  /// `columns`: what it adds to the record of a run. Throws std::invalid_argument if the name is taken.
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

  /// The columns of all parts, for the manual.
  std::vector<Column> columns() const {
    std::vector<Column> all;
    for (const Part& part : all_) all.insert(all.end(), part.columns.begin(), part.columns.end());
    return all;
  }

  /// Reads the parts whose sections the deck has, in the order of registration.
  std::vector<Chosen> read(Section& section) const {
    std::vector<Chosen> chosen;
    for (const Part& part : all_) {
      Reader reader{part, {}};
      if (section.optional_section(part.name, reader, part.meaning)) chosen.push_back({part.name, std::move(reader.make), part.columns});
    }
    return chosen;
  }

  /// Reads them from the section `name`, which only exists if there are parts to choose from.
  std::vector<Chosen> read(Section& outer, const char* name, const char* meaning) const {
    struct List {
      const Parts& parts;
      std::vector<Chosen> chosen;
      void declare(Section& section) { chosen = parts.read(section); }
    } list{*this, {}};
    if (!all_.empty()) outer.optional_section(name, list, meaning);
    return std::move(list.chosen);
  }

  /// Reads the part of this name, whose section the deck may leave out. Returns no function if there is no such part.
  Maker read(Section& section, const std::string& name) const {
    const auto part = std::ranges::find(all_, name, &Part::name);
    if (part == all_.end()) return {};
    Reader reader{*part, {}};
    section.section(name, reader, part->meaning);
    return std::move(reader.make);
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
