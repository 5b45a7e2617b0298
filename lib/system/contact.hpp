#pragma once
// Forces that hold particles apart.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/columns.hpp"
#include "base/types.hpp"
#include "spline/space.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// Two places of two surfaces, or of one and its image on a lattice, that lie close to each other, and the force that holds them apart.
struct Contact {
  std::array<std::size_t, 2> particle{};  ///< their numbers
  std::array<spline::Site, 2> site;       ///< on each one's own space
  Vec3 beyond = Vec3::Zero();             ///< lattice vector by which the second one is met elsewhere
  Vec3 normal = Vec3::Zero();             ///< out of the first one, of length 1
  double force = 0;                       ///< on the second one along the normal, and as large the other way on the first; not negative
};

/// All that hold, and the sum of forces times the time that they held for so far.
struct Contacts {
  std::vector<Contact> all;
  double impulse = 0;  ///< force x time

  double force() const;
  void add_columns(Columns& to) const;
};

/// Adds the virtual work of a contact of this force for a unit displacement of each control point, +-force N_A normal, to rows of all particles.
void add_work(std::span<const Particle> particles, const Contact& contact, double force, Net& work);

/// The same of all contacts with their forces, shape (n_points, 3); an empty net if there are none.
Net work(std::span<const Particle> particles, const Contacts& contacts, Eigen::Index n_points);

/// The f of f >= 0, A f + q >= 0, f.(A f + q) = 0, for a positive definite A: what holds gaps that are short by -q, where a unit of f_j opens gap k
/// by A_kj. By principal pivots of the least index (Murty 1974). Not finite where A lets no pivot be.
Eigen::VectorXd complementary(const Eigen::MatrixXd& a, const Eigen::VectorXd& q);

}  // namespace tanktread::coupling
