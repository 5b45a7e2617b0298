#pragma once
// Fields on a symmetric surface that reflections turn into themselves or into their opposite.

#include "base/types.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::surface {

/// The fields of one parity: the mirror plane across each axis turns them into themselves (1) or into their opposite (-1), half turns and the point
/// symmetry by the product of their axes. With 1 for all they are the symmetric fields; any field is a sum of one of each parity.
class Parity {
 public:
  explicit Parity(const Symmetry& symmetry, const Vec3& of_planes = Vec3::Ones());

  /// What the vector, or the scalar, of a point is multiplied by to be that of its source's image, as Symmetry::signs.
  const Net& signs() const { return signs_; }
  const Eigen::VectorXd& scalar_signs() const { return scalar_signs_; }

  /// Fields of this parity from their rows of the fundamental points, as Symmetry::complete.
  void complete(Net& field) const;
  void complete(Eigen::VectorXd& field) const;

 private:
  std::vector<int> source_;
  Net signs_;
  Eigen::VectorXd scalar_signs_;
};

}  // namespace tanktread::surface
