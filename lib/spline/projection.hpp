#pragma once
// Fields from one spline space to another that does not contain it.

#include <memory>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// Least squares at the 4 x 4 Gauss points of the elements of both spaces, weighted by parametric area. One factorisation serves all fields.
/// Both spaces must outlive it.
class Projection {
 public:
  Projection(const Space& from, const Space& to);
  ~Projection();
  Projection(Projection&&) noexcept;

  struct Result {
    Net net;
    std::vector<double> defect;  ///< of an element of `from`: largest |old - new| over the points in it
  };
  Result operator()(const Net& field) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tanktread::spline
