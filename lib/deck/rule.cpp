#include <cmath>

#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

Rule any() {
  return {"any number", [](double) { return true; }};
}

Rule positive() {
  return {"positive", [](double x) { return x > 0.0; }};
}

Rule not_negative() {
  return {"not negative", [](double x) { return x >= 0.0; }};
}

Rule at_least(double low) {
  return {"at least " + number_text(low), [low](double x) { return x >= low; }};
}

Rule between(double low, double high) {
  return {"between " + number_text(low) + " and " + number_text(high), [low, high](double x) { return x >= low && x <= high; }};
}

}  // namespace tanktread::deck
