#pragma once
// The phase of a material point of the surface.

#include <optional>

namespace tanktread {

/// The angle of a point, counted on past whole turns, and the angular velocity that the surface was left with.
struct Turning {
  double degrees = 0, rate = 0;

  /// A step on, in which the mean angular velocity of the surface became `now`: to the `angle` at which the point is, whole turns counted on, or
  /// where no point is followed by the mean.
  void advance(double step, double now, std::optional<double> angle);
};

}  // namespace tanktread
