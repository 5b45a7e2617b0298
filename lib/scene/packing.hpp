#pragma once
// Spheres at random in a cell that repeats, without overlap.

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "base/types.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread {

/// A sphere, by how much of its radius another one keeps away from it, and whether it stays where it is.
struct PackedSphere {
  Vec3 centre;
  double radius = 1, least_gap = 0;
  bool fixed = false;
};

/// Numbers between 0 and 1, the same with every standard library.
double uniform(std::mt19937_64& random);

/// The distance that the centres of two spheres keep: their radii, and `gap` times the larger one; by default the larger of their own gaps.
double least_distance(const PackedSphere& a, const PackedSphere& b, double gap);
inline double least_distance(const PackedSphere& a, const PackedSphere& b) { return least_distance(a, b, std::max(a.least_gap, b.least_gap)); }

/// Moves spheres that start anywhere to where none overlaps any other or its images, as hard spheres in thermal equilibrium: those that do are pushed
/// apart, two by two, until none do (after Jodrey & Tory 1985), and then all take random steps of which those that end in an overlap are taken back
/// (Metropolis et al. 1953). Equal spheres go up to a volume fraction of about 0.6, their gaps included. Whether there is room.
bool pack(std::vector<PackedSphere>& spheres, const stokes::PeriodicCell& cell, std::uint64_t seed);

}  // namespace tanktread
