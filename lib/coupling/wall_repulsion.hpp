#pragma once
// A short-ranged repulsion of membranes by the wall of a round tube or channel.

#include <functional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::coupling {

/// The wall around the axis x1, and what it does: per unstressed area the energy stress x range x exp(-g/range), where
/// g = radius(x1) - sqrt(x2^2 + x3^2). (3.22)
struct Repulsion {
  std::function<double(double)> radius;
  double stress = 0, range = 1;
};

/// Its load on the membranes of a space, and the part of its tangent that is stiff, along the normals. Serial; `elements` as of Membrane::load.
class WallRepulsion {
 public:
  /// `space` must outlive this.
  WallRepulsion(const spline::Space& space, const Net& unstressed, Repulsion repulsion);

  double energy(const Net& x, std::span<const int> elements) const;

  /// Adds dE/dx_A to d.
  void add_load(const Net& x, std::span<const int> elements, Net& d) const;

  /// Linearises at x on these elements.
  void update(const Net& x, std::span<const int> elements);

  /// Adds H u.
  void add_tangent(const Net& u, Net& hu) const;

 private:
  struct Place {
    int element, point;
    double energy;
    Vec3 gradient;  ///< of g
  };
  std::vector<Place> places(const Net& x, std::span<const int> elements) const;
  auto row(const Place& at) const { return value_[static_cast<std::size_t>(at.element)].row(at.point); }

  const spline::Space& space_;
  Repulsion repulsion_;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> value_;  // of the functions of an element, a row a Gauss point
  std::vector<Eigen::VectorXd> area_;                                                          // unstressed, of each Gauss point
  std::vector<Place> latest_;                                                                  // of update
};

}  // namespace tanktread::coupling
