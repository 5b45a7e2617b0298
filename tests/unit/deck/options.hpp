#pragma once
// Options with one key of every type, for the tests of the deck module.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "deck/document.hpp"
#include "deck/expectation.hpp"

namespace tanktread::deck {

struct Inner {
  double depth = 0.5;
  void declare(Section& s) { s.key("depth", depth, between(0.0, 1.0), "length", "how deep"); }
};

struct Kinds {
  double rate = 1.0;
  std::optional<double> modulus;
  int count = 3;
  std::optional<int> limit;
  bool enabled = false;
  std::string law = "soft";
  std::string note = "none";
  Vec3 center = Vec3::Zero();
  std::optional<Vec3> axes;
  std::optional<Eigen::Vector2d> sides;
  Mat3 gradient = Mat3::Identity();
  std::optional<Mat3> stress;
  std::optional<std::vector<double>> heights;
  Inner inner;
  std::shared_ptr<Teuchos::ParameterList> belos;

  void declare(Section& s) {
    s.key("shear rate", rate, positive(), "1/time", "rate of the flow");
    s.key("modulus", modulus, positive(), "force/length", "stiffness");
    s.key("count", count, between(1, 9), "1", "how many");
    s.key("limit", limit, at_least(0), "1", "at most so many");
    s.key("enabled", enabled, "whether");
    s.key("law", law, Choice{"soft", "hard", "very hard"}, "which | law");
    s.key("note", note, Choice{}, "any words");
    s.key("center", center, any(), "length", "where");
    s.key("axes", axes, positive(), "length", "three lengths");
    s.key("sides", sides, positive(), "length", "two lengths");
    s.key("gradient", gradient, any(), "1/time", "nine numbers");
    s.key("stress", stress, any(), "stress", "nine numbers");
    s.key("heights", heights, not_negative(), "length", "one length or more");
    s.section("Inner", inner, "a list in a list");
    s.foreign("Belos", belos, "as it is");
  }
};

struct Sample {
  Kinds kinds;
  Expectations expect;
  void declare(Section& s) {
    s.section("Kinds", kinds, "one key of each type");
    s.section("Expect", expect, "expected results");
  }
};

/// Returns the options from a deck with the given lines in its section `Kinds`.
inline Kinds kinds(const std::string& lines) {
  Sample sample;
  Document document = read_text("Tanktread:\n  Kinds:\n" + lines);
  document.declare(sample);
  return sample.kinds;
}

/// Returns the error message for a whole deck, or an empty text if there is none.
inline std::string refusal_of(const std::string& text) {
  try {
    Sample sample;
    Document document = read_text(text, "deck.yaml");
    document.declare(sample);
  } catch (const UserError& error) {
    return error.what();
  }
  return {};
}

/// Returns the error message for a deck with the given lines in its section `Kinds`.
inline std::string refusal(const std::string& lines) { return refusal_of("Tanktread:\n  Kinds:\n" + lines); }

}  // namespace tanktread::deck
