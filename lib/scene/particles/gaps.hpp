#pragma once
// Gaps between the particles of a run. On a lattice, given as `cell`, gaps to periodic images are included, also between a particle and images of
// itself.

#include <limits>
#include <optional>
#include <vector>

#include "scene/member.hpp"
#include "scene/series/diagnostics.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/contact.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread {

/// Pair of particles with the smallest gap: their numbers, from 1 in the order of the deck, the gap, and its midpoint.
struct Nearest {
  double gap = std::numeric_limits<double>::infinity();
  int first = 0, second = 0;
  Vec3 place = Vec3::Zero();
  void add_columns(Columns& to) const;
};

/// Returns the particles of the scene. Throws UserError if two of them overlap in their initial shapes, if they are closer than a run in time allows,
/// if one is inside another, or if one crosses a post. The message names the particles and the position, and says if only their meshes overlap.
std::vector<Member> checked_members(const Scene& scene);

/// Pair of particles close to each other: their contact (the two nearest points and the normal), without a force, and their gap.
struct Approach {
  coupling::Contact contact;
  double gap = 0;
};

/// Moves the two sites of `contact` to the nearest local minimum of the distance between the surfaces. Returns the contact there, with its normal and
/// gap.
Approach approach(const std::vector<Member>& members, const Net& x, coupling::Contact contact);

/// Returns, for every pair of particles whose gap at x is below `reach`, the points of smallest distance and the gap. The gap is 0 if the particles
/// touch. On a lattice, each image within reach counts as a pair. The ranks share the pairs; the result does not depend on the number of ranks.
/// Collective.
std::vector<Approach> approaches(const std::vector<Member>& members, const Net& x, double reach, const coupling::Ranks& ranks,
                                 const std::optional<stokes::PeriodicCell>& cell);

/// Returns the smallest gap between any two particles at x, accurate to 1e-7 of the largest radius R_C. Ranks share the pairs. Collective.
Nearest smallest_gap(const std::vector<Member>& members, const Net& x, const coupling::Ranks& ranks, const std::optional<stokes::PeriodicCell>& cell);

/// Returns the film width at each element (of Body::nested()) of particle p at x. The width is infinite if the film is so wide that every element of
/// the current mesh resolves it (AdaptationOptions::film_resolution). `cell`: cell of the lattice; films between the particle and periodic images of
/// particles and of the wall are included, posts are not. `wall`: wall of the tube around the particle, or null; x is given in the coordinates of the
/// wall.
std::vector<double> films(const std::vector<Member>& members, std::size_t p, const Net& x, const std::optional<stokes::PeriodicCell>& cell = {},
                          const surface::TubeWall* wall = nullptr);

/// Returns a sentence that two particles touch, such as "Particles/a and Particles/b touch", or that a particle touches its periodic image. `first`,
/// `second`: numbers of the particles, from 1 in the order of the deck.
std::string touching(const Scene& scene, int first, int second);

}  // namespace tanktread
