#include "motion/slopes.hpp"

#include <algorithm>
#include <cmath>

namespace tanktread::motion {

Slopes::Slopes(const std::vector<Net>& history, double step) {
  const double back[] = {0, -(1 - 2 * (1 - 1 / std::sqrt(2.0))), -1};
  for (size_t i = std::min<size_t>(history.size(), 3); i-- > 0;) add(back[i] * step, history[i]);
}

void Slopes::add(double time, const Net& slope) {
  times_.push_back(time);
  slopes_.push_back(&slope);
}

Net Slopes::at(double time, int order) const {
  const size_t count = std::min(slopes_.size(), static_cast<size_t>(order) + 1), first = slopes_.size() - count;
  Net sum = Net::Zero(slopes_.back()->rows(), 3);
  for (size_t i = first; i < slopes_.size(); ++i) {
    double weight = 1;
    for (size_t j = first; j < slopes_.size(); ++j)
      if (j != i) weight *= (time - times_[j]) / (times_[i] - times_[j]);
    sum += weight * *slopes_[i];
  }
  return sum;
}

}  // namespace tanktread::motion
