#include "scene/series/phase_angle.hpp"

#include <cmath>
#include <numbers>

namespace tanktread {

void PhaseAngle::advance(double step, double now, std::optional<double> angle) {
  const double expected = degrees + (rate + now) / 2 * step * 180 / std::numbers::pi;
  degrees = angle ? *angle + 360 * std::round((expected - *angle) / 360) : expected;
  rate = now;
}

}  // namespace tanktread
