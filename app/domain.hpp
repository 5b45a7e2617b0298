#pragma once
// The lattice that a scene repeats on: `Domain/*` of the deck.

#include <optional>
#include <string>

#include "base/types.hpp"
#include "stokes/flow_options.hpp"
#include "stokes/periodic_images.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread {

struct DomainOptions {
  bool present = false;  ///< whether the scene repeats at all; nothing else counts without

  std::string periodic = "x1 x2 x3";    ///< directions in which it does
  std::optional<Vec3> side_lengths;     ///< of a box
  std::optional<Mat3> lattice_vectors;  ///< rows; those of directions that do not repeat count for nothing

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other or are missing, and for a flow that the lattice cannot follow.
  void check(const stokes::FlowOptions& flow) const;

  /// Number of directions in which the scene repeats.
  int directions() const;

  /// The cell at the start; nothing where the scene does not repeat.
  std::optional<stokes::PeriodicCell> cell() const;

 private:
  Mat3 vectors() const;
};

}  // namespace tanktread
