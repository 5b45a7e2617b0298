#pragma once
// Random packings of spheres, by which copies of particles are placed.

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "base/types.hpp"
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

/// Returns the lattice vectors whose sum with some position in the cell around the origin is at most as long as `reach`, and possibly others.
std::vector<Vec3> images_within(const stokes::PeriodicCell& cell, double reach);

}  // namespace tanktread
