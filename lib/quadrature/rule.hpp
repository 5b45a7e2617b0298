#pragma once

#include <vector>

namespace tanktread::quadrature {

/// Points (s, t) of the unit square and their weights, in no particular arrangement.
struct Rule {
  std::vector<double> s, t, weights;

  int size() const { return static_cast<int>(weights.size()); }
  void clear() { s.clear(), t.clear(), weights.clear(); }
  void add(double at_s, double at_t, double weight) { s.push_back(at_s), t.push_back(at_t), weights.push_back(weight); }
};

}  // namespace tanktread::quadrature
