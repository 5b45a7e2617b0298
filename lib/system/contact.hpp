#pragma once
// Contact forces that keep particles apart.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/columns.hpp"
#include "base/types.hpp"
#include "spline/space.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// Two close points, on two surfaces or on a surface and one of its lattice images, and the contact force between these points.
struct Contact {
  std::array<std::size_t, 2> particle{};  ///< indices of the two particles
  std::array<spline::Site, 2> site;       ///< parametric point on the space of each particle
  Vec3 beyond = Vec3::Zero();             ///< lattice vector added to the second particle, whose image is in contact
  Vec3 normal = Vec3::Zero();             ///< unit normal out of the first particle
  double force = 0;                       ///< force on the second particle along the normal; the opposite force acts on the first; not negative
};

/// All active contacts, and the time integral of their forces so far.
struct Contacts {
  std::vector<Contact> all;
  double impulse = 0;  ///< time integral of the forces, force x time

  double force() const;
  void add_columns(Columns& to) const;
};

/// Adds the virtual work of a contact force per unit displacement of each control point A to `work`: -force N_A normal in the rows of the first
/// particle, and force N_A normal in the rows of the second.
void add_work(std::span<const Particle> particles, const Contact& contact, double force, Net& work);

/// Returns the virtual work of all contacts with their forces, shape (n_points, 3); an empty net if there are no contacts.
Net work(std::span<const Particle> particles, const Contacts& contacts, Eigen::Index n_points);

/// Solves the linear complementarity problem f >= 0, A f + q >= 0, f.(A f + q) = 0 for positive definite A. f are contact forces, A f + q are the
/// gaps minus the required gaps, and A_kj is the opening of gap k by a unit force f_j. Uses principal pivoting with the least-index rule (Murty
/// 1974). The result is not finite if pivoting does not terminate.
Eigen::VectorXd complementary(const Eigen::MatrixXd& a, const Eigen::VectorXd& q);

}  // namespace tanktread::coupling
