#include "app/turning.hpp"

#include <cmath>
#include <numbers>

namespace tanktread {

void Turning::advance(double step, double now, std::optional<double> angle) {
  const double expected = degrees + (rate + now) / 2 * step * 180 / std::numbers::pi;
  degrees = angle ? *angle + 360 * std::round((expected - *angle) / 360) : expected;
  rate = now;
}

}  // namespace tanktread
