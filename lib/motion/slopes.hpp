#pragma once

#include <vector>

#include "base/types.hpp"

namespace tanktread::motion {

/// Slopes dx/dt known at some times, and the polynomial through the latest of them. Times are relative to the start of the step.
class Slopes {
 public:
  /// From what TR-BDF2 keeps: slopes at the end, the middle stage and the start of the last step of size `step`.
  Slopes(const std::vector<Net>& history, double step);

  /// A further slope at a time after all others.
  void add(double time, const Net& slope);

  /// Value at `time` of the polynomial of at most `order` through the latest order + 1 slopes.
  Net at(double time, int order) const;

 private:
  std::vector<double> times_;  ///< ascending
  std::vector<const Net*> slopes_;
};

}  // namespace tanktread::motion
