#pragma once

#include <optional>
#include <string>

namespace tanktread::deck {
class Section;
}

namespace tanktread::output {

/// What is written and when the run pauses: `Output/*` of the deck.
struct Options {
  std::optional<double> interval;          ///< simulated time between snapshots; empty: a twentieth of the final time
  std::optional<std::string> between_steps;  ///< land or interpolate; empty: interpolate with a fixed step, land otherwise
  std::optional<double> wall_clock_limit;  ///< seconds after which the run stops with a checkpoint; empty: none

  bool power_balance = false;              ///< whether each row holds the balance of power
  bool surface_text = false;               ///< the last surface as Bezier-extraction text, `surface.iga`

  void declare(deck::Section& section);
};

}  // namespace tanktread::output
