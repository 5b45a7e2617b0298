#pragma once
// Short-range repulsion of membranes by the wall of a round tube or channel.

#include <functional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// A wall around the axis x1 and its repulsion. The energy per unstressed area is stress x range x exp(-g/range), with the gap g = radius(x1) -
/// sqrt(x2^2 + x3^2). (3.22)
struct Repulsion {
  std::function<double(double)> radius;
  double stress = 0, range = 1;
};

/// Load of the wall repulsion (3.22) on a membrane. Its energy is not part of the membrane's elastic energy. Its tangent contains only the stiff
/// part, the change of the force with the gap g, and neglects the change of the wall's normal.
class WallRepulsion : public Load {
 public:
  /// `space` must outlive this object.
  WallRepulsion(const spline::Space& space, const Net& unstressed, Repulsion repulsion);

  void add_work(const Net& x, std::span<const int> elements, Net& work, std::span<Net> sums) const override;
  void linearise(const Net& x, std::span<const int> elements, std::span<const Net> sums) override;
  void add_tangent(const Net& dx, Net& change) const override;
  // Returns true for images that do not reverse the axis x1. The caller checks the symmetry of the wall.
  bool admits(const surface::Image& image) const override { return image.signs[0] > 0; }
  // Returns an empty set of conditions. In a tube only the axial translation can be a free motion, and it does not change this repulsion.
  RigidConditions rigid_conditions() const override { return RigidConditions(0, 6); }
  bool depends_on_labels() const override { return false; }

 private:
  struct RepulsionPoint {
    int element, point;
    double energy;
    Vec3 gradient;  ///< gradient of g
  };
  std::vector<RepulsionPoint> places(const Net& x, std::span<const int> elements) const;
  auto row(const RepulsionPoint& at) const { return value_[static_cast<std::size_t>(at.element)].row(at.point); }

  const spline::Space& space_;
  Repulsion repulsion_;
  // per element: values of its basis functions, one row per Gauss point
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> value_;
  std::vector<Eigen::VectorXd> area_;   // per element: unstressed area that each Gauss point represents
  std::vector<RepulsionPoint> latest_;  // points at the linearisation
};

}  // namespace tanktread::membrane
