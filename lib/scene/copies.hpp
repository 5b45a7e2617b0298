#pragma once
// Copies of a particle: `Particles/<name>/copies`, and random packings of spheres.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/section.hpp"
#include "scene/domain.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread {

/// Sphere of a packing: its centre and radius, its least gap to another sphere divided by the larger of the two radii, and whether it is fixed.
struct PackedSphere {
  Vec3 centre;
  double radius = 1, least_gap = 0;
  bool fixed = false;
};

/// Returns a uniform random number in [0, 1). The sequence is the same with every standard library.
double uniform(std::mt19937_64& random);

/// Returns the least distance of the centres of two spheres: the sum of their radii plus `gap` times the larger radius. The function without `gap`
/// uses the larger `least_gap` of the two spheres.
double least_distance(const PackedSphere& a, const PackedSphere& b, double gap);
inline double least_distance(const PackedSphere& a, const PackedSphere& b) { return least_distance(a, b, std::max(a.least_gap, b.least_gap)); }

/// Moves spheres from arbitrary positions to an arrangement without overlaps of spheres and periodic images, distributed as hard spheres in thermal
/// equilibrium. First, overlapping pairs are pushed apart until none overlap (after Jodrey & Tory 1985). Then all spheres take random steps, and
/// steps that end in an overlap are undone (Metropolis et al. 1953). For equal spheres, pack() succeeds up to a volume fraction of about 0.6, gaps
/// included. Returns false if overlaps remain.
bool pack(std::vector<PackedSphere>& spheres, const stokes::PeriodicCell& cell, std::uint64_t seed);

struct ParticleKind;

/// Options `Particles/<name>/copies`. Positions from file, lattice and packing are relative to the particle's centre. The orientation of the particle
/// is applied first, then the orientation of the copy.
struct CopiesOptions {
  std::optional<std::string> file;    ///< CSV file: per row a centre, and optionally a rotation vector in degrees
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
  bool in_cell() const { return random() && !box && !ball; }

  /// Throws UserError, with a message of one sentence, if keys contradict each other. `list`: path of the section `copies`. `cell`: true if the scene
  /// is periodic in three directions.
  void check(const std::string& list, bool cell) const;
};

/// Returns the kinds of particles after each kind with copies is replaced by one kind per copy, named `<name> 1`, `<name> 2`, …. Copies at random
/// positions in a box or ball do not overlap the circumscribed spheres of earlier particles. Copies at random positions in the cell, of all kinds
/// together, are moved until no two particles overlap. Throws UserError if a file does not hold positions, if the copies do not fit, or if a copy has
/// the name of another particle.
std::vector<ParticleKind> with_copies(const std::vector<ParticleKind>& kinds, const DomainOptions& domain);

}  // namespace tanktread
