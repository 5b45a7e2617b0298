#pragma once
// Flows that change in time.

#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "deck/table.hpp"

namespace tanktread::stokes {

/// Options `Flow/history` of the deck: time dependence of the ambient flow. At each time the flow is a Q v(Q^T x) with an amplitude a and a rotation
/// Q (2.21).
struct FlowHistory {
  std::string type = "table";                     ///< "table" or "sine"
  std::optional<std::vector<double>> times;       ///< times of the table, in order; two equal times are a jump
  std::optional<std::vector<double>> amplitudes;  ///< amplitudes at `times`, linear in between, constant before and after; 1 if only angles are
                                                  ///< given
  std::optional<std::vector<double>> angles;      ///< rotation angles of the flow at `times`, in degrees; if not given, the flow is not rotated
  std::optional<deck::TableFile> file;            ///< file with the columns time, amplitude, angle
  std::optional<std::string> axis;                ///< axis about which the flow is rotated; set if angles are given
  std::optional<double> mean, amplitude, frequency, phase;  ///< parameters of the sine: mean + amplitude sin(2 pi frequency t + phase), phase in
                                                            ///< degrees

  void declare(deck::Section& section);

  /// Reads the table from `file`, if given, into times, amplitudes and angles.
  void read();

  /// Throws UserError if keys contradict each other or are missing.
  void check() const;

  struct Moment {
    double amplitude = 1;
    Mat3 turn = Mat3::Identity();
    double angle = 0;  ///< angle of `turn` in degrees
  };

  /// Returns amplitude and rotation at a time, in a step that began at `start`. If they jump at this time, returns the values after the jump for a
  /// step that starts at the jump, and the values before the jump for all other steps.
  Moment at(double time, double start) const;

  /// Returns the deformation F that a uniform gradient L causes from time 0 to `time` >= 0: dF/dt = a Q L Q^T F, F(0) = I (2.51), with the amplitude
  /// a and the rotation Q of this history. Exact up to round-off. `gradient`: L, 1/time.
  Mat3 deformation(const Mat3& gradient, double time) const;

  /// Returns the rotation by an angle in degrees about `axis`.
  Mat3 turn(double angle) const;

  /// Returns the first time of the table after `time`, or infinity.
  double next_kink(double time) const;

  /// Returns whether the table contains this time or a later time, so that the flow may still change. If the flow jumps at `time`, it still has to
  /// change, because a step that ends at the jump uses the values before the jump.
  bool lasts(double time) const { return type == "table" && times->back() >= time; }
};

}  // namespace tanktread::stokes
