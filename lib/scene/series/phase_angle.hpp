#pragma once
// Phase angle of tank-treading or rotation.

#include <optional>

namespace tanktread {

/// Phase of a material point: its angle, which grows beyond 360 degrees after a whole turn, and the mean angular velocity of the surface at the last
/// step (`rate`, in radians per time).
struct PhaseAngle {
  double degrees = 0, rate = 0;

  /// Advances the phase by a step. `now`: mean angular velocity of the surface at the end of the step. `angle`: angle of the followed point, if
  /// known; the phase then becomes this angle plus whole turns. Otherwise the phase is integrated from the mean angular velocity.
  void advance(double step, double now, std::optional<double> angle);
};

}  // namespace tanktread
