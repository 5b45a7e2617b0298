#pragma once
// Copies of a particle: `Particles/<name>/copies`.

#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/section.hpp"
#include "scene/domain.hpp"

namespace tanktread {

struct ParticleKind;

/// Options `Particles/<name>/copies`. Positions from file, lattice and packing are relative to the particle's centre. The orientation of the particle
/// is applied first, then the orientation of the copy. It turns the shape only: forces, torques and velocities keep their components along the axes
/// of space.
struct CopiesOptions {
  std::optional<deck::TableFile> file;  ///< table: per row a centre, and optionally a rotation vector in degrees
  std::optional<Vec3> lattice;        ///< number of copies along x1, x2, x3
  std::optional<Vec3> spacing;        ///< distances of neighbouring centres on the lattice
  std::optional<int> number;          ///< number of copies placed at random
  std::optional<double> volume_fraction;  ///< volume fraction of the copies, from which the number of copies follows
  std::optional<Vec3> box;            ///< side lengths of the box that contains all copies entirely
  /// Radius of the ball that contains all copies. Without `box` and `ball`, copies at random positions fill the periodic cell, which must then be
  /// periodic in three directions.
  std::optional<double> ball;
  double least_gap = 0.05;            ///< least gap between the circumscribed spheres of two copies, divided by the larger radius
  int seed = 1;
  bool present = false;               ///< true if the deck has the section `copies` of this kind of particle

  void declare(deck::Section& section);
  bool random() const { return number || volume_fraction; }

  /// Region in which copies are placed at random: `box`, `ball`, or the periodic cell if neither is given.
  enum class Region { box, ball, cell };
  Region region() const { return box ? Region::box : ball ? Region::ball : Region::cell; }
  bool in_cell() const { return random() && region() == Region::cell; }

  /// Throws UserError, with a message of one sentence, if keys contradict each other. `list`: path of the section `copies`. `cell`: true if the scene
  /// is periodic in three directions.
  void check(const std::string& list, bool cell) const;
};

/// Returns the kinds of particles after each kind with copies is replaced by one kind per copy, named `<name> 1`, `<name> 2`, …. Copies at random
/// positions in a box or ball do not overlap the circumscribed spheres of earlier particles and of their images on the lattice. Copies at random
/// positions in the cell, of all kinds together, are moved until no two particles overlap. Throws UserError if a file does not hold positions, if the
/// copies do not fit, if a volume fraction is given but the volume of a particle is not known, or if a copy has the name of another particle.
std::vector<ParticleKind> with_copies(const std::vector<ParticleKind>& kinds, const DomainOptions& domain);

}  // namespace tanktread
