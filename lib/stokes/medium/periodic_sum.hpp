#pragma once
// Far sums over a lattice of images. Near images are treated like other sources. The sum over all other images is smooth and is interpolated at
// Chebyshev nodes of the cell.

#include <array>
#include <span>
#include <vector>

#include "base/pack.hpp"
#include "base/types.hpp"
#include "stokes/kernels/cluster_kernel.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread::stokes {

/// Splits the kernel of a lattice into near images, which the caller treats like other sources, and a smooth sum over all other images
/// (PeriodicKernel). Each source and each target is first moved into the cell. The smooth sum is interpolated at both sources and targets in lattice
/// coordinates, as between clusters (TreeSum). With p nodes in one direction, the interpolation error is of the order rho^(-p), rho = y + sqrt(1 +
/// y^2), as in (2.9). Here y is the distance to the nearest image that is not near, divided by half the length of the cell in this direction.
class PeriodicSum {
 public:
  /// `tolerance`: error of the sum relative to the kernel at a distance of half a cell. `extent`: lowest and highest lattice coordinates of all
  /// positions, for directions that do not repeat.
  PeriodicSum(PeriodicKernel::Kind kind, const PeriodicCell& cell, double tolerance, const std::array<Vec3, 2>& extent);

  const PeriodicCell& cell() const { return cell_; }
  const std::vector<Vec3>& images() const { return images_; }  ///< lattice vectors of the near images, including 0

  /// Returns whether a PeriodicSum constructed for `extent` would be equal to this one.
  bool suits(const std::array<Vec3, 2>& extent) const;

  /// Returns the position moved into the cell. The cell is displaced from the origin, because kernels take a node and a target for coincident if
  /// their distance is below 2^-40 times the distance of the target from the origin. Near the origin, rounding errors would exceed this threshold.
  Vec3 wrapped(const Vec3& x) const { return x - cell_.shift(x) + away_; }

  /// Adds the smooth sum over all images that are not near to u[3 k + c], component c at target k. Sources and targets are positions in the cell. A
  /// source has the 3 components of a force or the 6 components of a stresslet in the order of StressletKernel.
  void add_remainder(const Charges& sources, std::span<const Vec3> targets, double* u) const;

  /// Returns the Lagrange polynomials of the interpolation nodes at positions in the cell, shape (number of positions, n_nodes).
  Eigen::MatrixXd lagrange(std::span<const Vec3> places) const;

  /// Returns component c = 11, 12, 13, 22, 23, 33 of the smooth Stokeslet sum (over all images that are not near) between the interpolation nodes,
  /// shape (n_nodes, n_nodes).
  Eigen::MatrixXd between_nodes(int component) const;
  int n_nodes() const { return box_.n_nodes(); }

 private:
  Vec3 in_box(const Vec3& wrapped) const;
  void apply(const std::vector<double> (&q)[6], std::vector<double>& u) const;

  PeriodicKernel::Kind kind_;
  PeriodicCell cell_;
  Vec3 away_, low_, length_;    // away_: displacement of the cell from the origin. low_, length_: lowest corner and side lengths of the interpolation
                                // box, in lattice coordinates
  std::array<Vec3, 2> across_;  // lowest and highest coordinates of the interpolation box, in directions that are not periodic
  ChebyshevBox box_;            // box from -1/2 to 1/2
  std::vector<Vec3> images_;
  std::array<std::vector<int>, 3> difference_;  // for each direction with n nodes, entry n a + b: index of the difference of nodes a and b in the
                                                // list of distinct differences
  std::array<std::size_t, 3> differences_;      // number of distinct differences of two nodes in each direction
  std::vector<double> table_;  // entry m ((n_1 i + j) n_2 + k) + c, with m = components_ and n_d = differences_[d]: component c of the smooth kernel
                               // sum for the node difference (i, j, k)
  int components_ = 6;
};

}  // namespace tanktread::stokes
