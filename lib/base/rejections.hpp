#pragma once
// Combinations of choices that the program rejects.

#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"

namespace tanktread {

/// Two texts for one choice in a deck. `here`: the choice of the current deck, for messages. `any`: the choice in general terms, for the table of all
/// rejected combinations.
struct Chosen {
  Chosen(const char* always) : here(always), any(always) {}
  Chosen(std::string always) : here(std::move(always)), any(here) {}
  Chosen(std::string in_this_deck, std::string in_general) : here(std::move(in_this_deck)), any(std::move(in_general)) {}

  std::string here, any;
};

/// Collects combinations of choices that contradict each other. Functions of the scene named reject...() add the combinations with their reasons.
class Rejections {
 public:
  struct Row {
    std::string one, other, why;
  };

  /// `every`: if true, collects all rejected combinations that any deck could contain, as rows of a table. If false, collects one sentence for each
  /// rejected combination that the current deck contains.
  explicit Rejections(bool every = false) : every_(every) {}

  /// Adds the combination of two choices if both are made (`both`) or if all combinations are collected. `why`: reason, without a full stop. `both`
  /// is also evaluated for a default scene, with every() true: a condition that needs keys of the deck must test every() first.
  void pair(bool both, const Chosen& one, const Chosen& other, const std::string& why) {
    if (every_) rows_.push_back({one.any, other.any, why});
    else if (both) sentences_.push_back(contradiction(one.here, other.here, why));
  }
  void add(bool wrong, const std::string& sentence) {
    if (wrong && !every_) sentences_.push_back(sentence);
  }
  bool every() const { return every_; }
  void throw_if_any() const { require_none(sentences_); }
  const std::vector<Row>& rows() const { return rows_; }

 private:
  bool every_;
  std::vector<std::string> sentences_;
  std::vector<Row> rows_;
};

}  // namespace tanktread
