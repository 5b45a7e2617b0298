#pragma once
// What a surface carries along beside its shape: numbers that load it, and that change as it moves.

#include <Eigen/Core>

#include "base/types.hpp"

namespace tanktread::membrane {

/// Numbers q on a surface, of the order of 1. Serial.
class Carried {
 public:
  virtual ~Carried() = default;

  virtual Eigen::Index size() const = 0;                      ///< of q
  virtual Eigen::VectorXd start(const Net& shape) const = 0;  ///< q of a run that begins with this shape

  /// Takes the surface x and q there: what follows is of both.
  virtual void place(const Net& x, const Eigen::VectorXd& q) = 0;

  /// What q adds to the load (3.6), shape (N, 3).
  virtual Net load() const = 0;

  /// dq/dt, where the fluid is faster than the control points by `faster` (control values).
  virtual Eigen::VectorXd rate(const Net& faster) const = 0;

  virtual double energy() const = 0;  ///< that q adds to what the surface stores
};

}  // namespace tanktread::membrane
