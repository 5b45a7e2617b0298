#pragma once
// Equations of the walls and other solids that bound the fluid.

#include "system/system.hpp"

namespace tanktread::coupling {

/// Walls whose unknowns are eliminated: they answer by the factors of their own rows, (2.6), (2.7) and (2.46).
class EliminatedWalls : public Equation {
 public:
  EliminatedWalls(const FluidWalls& walls, Phases& phases) : walls_(walls), phases_(phases) {}

  std::string plan() const override {
    return std::string(walls_.tube ? "wall traction and pressure drop" : "tractions of plates and posts") + ", eliminated by factors";
  }
  void answer(const BlockVector& x, Given given, Sources& to) const override;

 private:
  FluidWalls walls_;
  Phases& phases_;
};

/// Wall of a duct whose traction f^D and pressure drop dp are unknowns:
///
///   (1/mu) G_W f^D - dp c - u = 0   at the wall (2.6),   dp - dp(f, v) = 0   (2.7)
///
/// with the velocity u that the particles cause at the wall, and the pressure drop dp(f, v) that they cause.
class DuctWall : public Equation {
 public:
  /// `form`: word of Solvers/tube that chooses the preconditioner. `block triangular`: dp includes the effect of the particles, and f^D that of
  /// particles and dp. `block diagonal`: without these. `block`: none.
  DuctWall(Tube& tube, const Layout& unknowns, std::string form);

  /// Returns the blocks of f^D (control values of the traction) and dp, in the unit mu/R_T, so that their numbers are velocities. mu: `viscosity`.
  static std::vector<Block> unknowns(const Tube& tube, double viscosity);

  std::string plan() const override { return "wall traction and pressure drop, preconditioner `" + form_ + "`"; }
  void answer(const BlockVector& x, Given given, Sources& to) const override;
  void add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity& u, Given given, BlockVector& r) const override;
  void precondition(const BlockVector& r, BlockVector& x) const override;

 private:
  Tube& tube_;
  std::string form_;
  BlockId traction_, drop_;
  double unit_;  // unit of dp: its row is divided by it, so that the residual is a velocity
};

}  // namespace tanktread::coupling
