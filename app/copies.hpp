#pragma once
// One particle of the deck placed many times.

#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/section.hpp"

namespace tanktread {

struct ParticleKind;

/// `Particles/<name>/copies`. The particle's centre is the origin of file, lattice and packing; its orientation comes before a copy's own.
struct CopiesOptions {
  std::optional<std::string> file;    ///< CSV: a centre a row, and a rotation vector in degrees or nothing
  std::optional<Vec3> lattice;        ///< counts along x1, x2, x3
  std::optional<Vec3> spacing;        ///< of the lattice
  std::optional<int> number;          ///< placed at random
  std::optional<double> volume_fraction;  ///< which gives the number
  std::optional<Vec3> box;            ///< side lengths of what they lie in, whole
  std::optional<double> ball;         ///< its radius
  double least_gap = 0.05;            ///< between the spheres around them, over the radius of those
  int seed = 1;
  bool present = false;               ///< whether the deck has this list at all

  void declare(deck::Section& section);
  void check(const std::string& list) const;  ///< one sentence (UserError) for keys that contradict each other
};

/// The kinds with every copy as one of its own, `<name> 1`, `<name> 2`, …. What is placed at random keeps clear of all that is placed before it, as
/// far as the spheres around them tell. Throws UserError for a file that does not hold places, or where there is no room.
std::vector<ParticleKind> with_copies(const std::vector<ParticleKind>& kinds);

}  // namespace tanktread
