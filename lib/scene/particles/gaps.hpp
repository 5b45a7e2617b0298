#pragma once
// The gaps between the particles of a run.

#include <limits>
#include <optional>
#include <vector>

#include "scene/member.hpp"
#include "scene/series/diagnostics.hpp"
#include "surface/tube_wall.hpp"
#include "system/contact.hpp"
#include "system/ranks.hpp"

namespace tanktread {

/// The two of several particles that are nearest to each other, by their numbers from 1 in the order of the deck, and the midpoint between them.
struct Nearest {
  double gap = std::numeric_limits<double>::infinity();
  int first = 0, second = 0;
  Vec3 place = Vec3::Zero();
  void add_columns(Columns& to) const;
};

/// On a lattice, `cell`, particles meet images of each other and of themselves too.

/// Throws UserError, which names the two and their gap, where two particles meet in their initial shapes, or one is inside of another.
void check_apart(const std::vector<Member>& members, const std::optional<stokes::PeriodicCell>& cell);

/// Two particles close to each other: their nearest points, the force not known, and their gap.
struct Approach {
  coupling::Contact contact;
  double gap = 0;
};

/// Of the two sites of `contact` the true minimum of the distance around, and the normal there.
Approach approach(const std::vector<Member>& members, const Net& x, coupling::Contact contact);

/// Of every two particles at x that are closer than `reach`, on a lattice as often as they are: the true minimum of their distance, 0 where they
/// meet. The same on any number of ranks, which share the pairs. Collective.
std::vector<Approach> approaches(const std::vector<Member>& members, const Net& x, double reach, const coupling::Ranks& ranks,
                                 const std::optional<stokes::PeriodicCell>& cell);

/// The smallest gap between any two particles at x, to 1e-7 of the largest R_C. Ranks share the pairs. Collective.
Nearest smallest_gap(const std::vector<Member>& members, const Net& x, const coupling::Ranks& ranks, const std::optional<stokes::PeriodicCell>& cell);

/// Width of the film beside each element of particle p at x, on its nested space, as far as its mesh has to know: elements of the first mesh are
/// short enough beside wider ones. `cell`: of the lattice, whose images bound films too. `wall`: of the tube around it, in whose frame x is, where
/// there is one.
std::vector<double> films(const std::vector<Member>& members, std::size_t p, const Net& x, const std::optional<stokes::PeriodicCell>& cell = {},
                          const surface::TubeWall* wall = nullptr);

/// Returns "Particles/a and Particles/b touch", or that one touches its image, from the particles' numbers in the order of the deck, from 1.
std::string touching(const Scene& scene, int first, int second);

}  // namespace tanktread
