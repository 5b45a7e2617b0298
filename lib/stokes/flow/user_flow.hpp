#pragma once
// Interface of ambient flows that a program adds.

#include <memory>

#include "base/types.hpp"
#include "deck/parts.hpp"

namespace tanktread::stokes {

/// An ambient flow in unbounded space at amplitude 1, a solution of Stokes' equations. `Flow/history` may scale and turn it about the origin (2.21).
class UserFlow {
 public:
  virtual ~UserFlow() = default;
  virtual Vec3 velocity(const Vec3& x) const = 0;  ///< length/time
  virtual Mat3 gradient(const Vec3& x) const = 0;  ///< dv_i/dx_j, without trace, 1/time
  virtual double rate() const = 0;                 ///< the rate of Ca, 1/time; 0: the flow has no gradient
  virtual bool affine() const { return false; }    ///< whether the gradient is the same everywhere; lattices need that
};

using UserFlows = deck::Parts<std::shared_ptr<const UserFlow>()>;

}  // namespace tanktread::stokes
