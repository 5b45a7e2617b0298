#pragma once
// Flows that change in time.

#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::stokes {

/// How the ambient flow changes in time: `Flow/history` of the deck. At each moment a Q v(Q^T x), with an amplitude a and a turn Q (2.21).
struct FlowHistory {
  std::string type = "table";                     ///< or sine
  std::optional<std::vector<double>> times;       ///< of the table, in order; two equal ones are a jump
  std::optional<std::vector<double>> amplitudes;  ///< at these times, straight in between, constant before and after; 1 where there are angles only
  std::optional<std::vector<double>> angles;      ///< at these times, in degrees; 0 where there are none
  std::optional<std::string> file;                ///< that holds these three
  std::optional<std::string> axis;                ///< about which the flow is turned; set with angles
  std::optional<double> mean, amplitude, frequency, phase;  ///< of the sine: mean + amplitude sin(2 pi frequency t + phase), phase in degrees

  void declare(deck::Section& section);

  /// The table of `file`, if it is given, into times, amplitudes and angles.
  void read();

  /// One sentence (UserError) for keys that contradict each other or are missing.
  void check() const;

  struct Moment {
    double amplitude = 1;
    Mat3 turn = Mat3::Identity();
  };

  /// The flow at a time, in a step that began at `start`: at a jump, what was before, unless the step starts there.
  Moment at(double time, double start) const;

  /// The turn by an angle in degrees about `axis`.
  Mat3 turn(double angle) const;

  /// The first time of the table after this one, or infinity.
  double next_kink(double time) const;
};

}  // namespace tanktread::stokes
