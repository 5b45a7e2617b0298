#pragma once
// Equations that a program adds to the system of all particles (Registry::equations).

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "system/particle.hpp"
#include "system/system.hpp"

namespace tanktread::coupling {

/// Particles on which an added equation may act, with their resting control net, shape (N, 3). `viscosity`: mu of the outer fluid. Particles and net
/// exist as long as the equation.
struct ParticlesAtRest {
  std::span<const Particle> particles;
  const Net& rest;
  double viscosity;

  /// Returns the index of the particle Particles/<name>. Throws UserError, which names the key of the deck `key`, if there is none.
  std::size_t named(const std::string& name, const std::string& key) const;
};

/// An equation that a program adds, with unknowns of its own, on one mesh of the particles; a new mesh has a new object, made from the resting net.
/// The shapes x are stacked control nets, shape (N, 3). On a lattice, they are the positions of the particles, not of their images in the cell.
/// Every rank computes everything.
class UserEquation {
 public:
  virtual ~UserEquation() = default;

  /// Returns the blocks of its unknowns, on no particle (Block::on = -1). If the unknowns of rigid bodies are tractions, the unknowns of the equation
  /// are found together with the motions of the bodies: each takes a column of a dense matrix, and a linear solve if it acts on deformable particles.
  /// Otherwise the iterative solver of the velocity contains them.
  virtual std::vector<Block> unknowns() const = 0;

  /// Returns the equation at the shape x. `all`: layout with the blocks, which differs from call to call. Called functions of the result:
  /// - add_sources adds the virtual work (Sources::work) of loads that are linear in the unknowns;
  /// - add_residual adds rows that are linear in the unknowns and in the velocity at the control points (SurfaceVelocity::of_points), are of the
  ///   order of velocities, and use nothing else;
  /// - precondition, if the identity is no good inverse of the rows.
  virtual std::unique_ptr<const Equation> at(const Net& x, const Layout& all) const = 0;

  /// Adds the change of the virtual work of the unknowns in `solution` due to the displacement dx from x, for the Jacobian. The Jacobian omits the
  /// change of the rows.
  virtual void add_work_change(const Net& /*x*/, const BlockVector& /*solution*/, const Net& /*dx*/, Net& /*change*/) const {}

  /// Corrects the shape after a step, after volumes are restored, for example so that a length is kept exactly. Rigid bodies are fitted to the
  /// result.
  virtual void restore(Net& /*x*/) const {}

  /// Returns the values of its columns. `solution` is NaN if there is no velocity at x.
  virtual std::vector<double> values(const Net& /*x*/, const BlockVector& /*solution*/) const { return {}; }
};

/// All equations that a program adds.
class UserEquations {
 public:
  UserEquations() = default;
  /// `rest` and the particles must outlive this object.
  UserEquations(std::span<const UserEquationMaker> makers, const ParticlesAtRest& rest) {
    for (const UserEquationMaker& make : makers) all_.push_back(make(rest));
  }

  bool empty() const { return all_.empty(); }
  /// Returns these blocks, followed by the blocks of all equations.
  std::vector<Block> after(std::vector<Block> blocks) const {
    for (const auto& one : all_) std::ranges::move(one->unknowns(), std::back_inserter(blocks));
    return blocks;
  }
  /// Returns the equations at the shape x.
  System::Equations at(const Net& x, const Layout& all) const {
    System::Equations equations;
    for (const auto& one : all_) equations.push_back(one->at(x, all));
    return equations;
  }
  void add_work_change(const Net& x, const BlockVector& solution, const Net& dx, Net& change) const {
    for (const auto& one : all_) one->add_work_change(x, solution, dx, change);
  }
  void restore(Net& x) const {
    for (const auto& one : all_) one->restore(x);
  }
  const UserEquation& operator[](std::size_t k) const { return *all_[k]; }

 private:
  std::vector<std::shared_ptr<const UserEquation>> all_;
};

}  // namespace tanktread::coupling
