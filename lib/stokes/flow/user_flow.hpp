#pragma once
// Interface for user-defined ambient flows.

#include <memory>

#include "base/types.hpp"
#include "deck/parts.hpp"

namespace tanktread::stokes {

/// An ambient flow in unbounded space at amplitude 1, a solution of the Stokes equations. `Flow/history` may scale it and rotate it about the origin
/// (2.21).
class UserFlow {
 public:
  virtual ~UserFlow() = default;
  virtual Vec3 velocity(const Vec3& x) const = 0;  ///< returns the velocity at x, length/time
  virtual Mat3 gradient(const Vec3& x) const = 0;  ///< dv_i/dx_j, trace-free, 1/time
  virtual double rate() const = 0;                 ///< rate with which the capillary number is defined, 1/time; 0 if the flow has no gradient
  virtual bool affine() const { return false; }    ///< true if the velocity gradient is uniform in space
};

using UserFlows = deck::Parts<std::shared_ptr<const UserFlow>()>;

}  // namespace tanktread::stokes
