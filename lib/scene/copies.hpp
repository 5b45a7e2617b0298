#pragma once
// One particle of the deck placed many times.

#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/section.hpp"
#include "scene/domain.hpp"

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
  std::optional<double> ball;         ///< its radius; of neither: all of the cell of a lattice of three directions, across its faces
  double least_gap = 0.05;            ///< between the spheres around them, over the radius of those
  int seed = 1;
  bool present = false;               ///< whether the deck has this list at all

  void declare(deck::Section& section);
  bool random() const { return number || volume_fraction; }
  bool in_cell() const { return random() && !box && !ball; }

  /// One sentence (UserError) for keys that contradict each other; `cell`: whether there is one of three directions.
  void check(const std::string& list, bool cell) const;
};

/// The kinds with every copy as one of its own, `<name> 1`, `<name> 2`, …. What is placed at random in a box or ball keeps clear of all that is
/// placed before it, as far as the spheres around them tell; what is placed in the cell, all of it together, of everything (packing.hpp). Throws
/// UserError for a file that does not hold places, or where there is no room.
std::vector<ParticleKind> with_copies(const std::vector<ParticleKind>& kinds, const DomainOptions& domain);

}  // namespace tanktread
