#pragma once
// Far sums over a lattice of images: those near as sources like any other, the smooth rest between Chebyshev nodes of the cell.

#include <array>
#include <span>
#include <vector>

#include "base/pack.hpp"
#include "base/types.hpp"
#include "stokes/kernels/cluster_kernel.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread::stokes {

/// The kernel of one lattice split into images that are near, for the far sum, and a smooth rest (PeriodicKernel). Sources and targets are put into
/// the cell one by one; the rest is interpolated on both sides in lattice coordinates, like between clusters (TreeSum): with y twice the distance of
/// the nearest image in it over the length of the cell, p nodes along that err like rho^(-p), rho = y + sqrt(1 + y^2), cf. (2.9).
class PeriodicSum {
 public:
  /// `tolerance`: of the sum, relative to one term at half a cell. `extent`: lowest and highest coordinate of all places, for directions across.
  PeriodicSum(PeriodicKernel::Kind kind, const PeriodicCell& cell, double tolerance, const std::array<Vec3, 2>& extent);

  const PeriodicCell& cell() const { return cell_; }
  const std::vector<Vec3>& images() const { return images_; }  ///< H n of those near, 0 among them

  /// Returns whether a sum made for these lowest and highest coordinates would be this one.
  bool suits(const std::array<Vec3, 2>& extent) const;

  /// The place in the cell; far from the origin, near which kernels would take close points for equal ones.
  Vec3 wrapped(const Vec3& x) const { return x - cell_.shift(x) + away_; }

  /// Adds the rest at targets, in the cell: u[3 k + c]. Sources are places in the cell with 3 numbers of forces, or 6 of stresslets in the order of
  /// StressletKernel.
  void add_rest(const Charges& sources, std::span<const Vec3> targets, double* u);

  /// Lagrange polynomials of the nodes that the rest is interpolated between, at places in the cell: shape (number of places, n_nodes).
  Eigen::MatrixXd lagrange(std::span<const Vec3> places) const;

  /// Component c = 11, 12, 13, 22, 23, 33 of the rest of the Stokeslet between these nodes, shape (n_nodes, n_nodes).
  Eigen::MatrixXd between_nodes(int component) const;
  int n_nodes() const { return box_.n_nodes(); }

 private:
  Vec3 in_box(const Vec3& wrapped) const;
  void apply(const std::vector<double> (&q)[6], std::vector<double>& u) const;

  PeriodicKernel::Kind kind_;
  PeriodicCell cell_;
  Vec3 away_, low_, length_;  // of the box, in coordinates of the cell
  std::array<Vec3, 2> across_;  // lowest and highest coordinates that the rest is made for, in directions that do not repeat
  ChebyshevBox box_;          // half a unit each way
  std::vector<Vec3> images_;
  std::array<std::vector<int>, 3> difference_;  // of nodes a, b of one direction: number n a + b
  std::array<std::size_t, 3> differences_;      // how many there are
  std::vector<double> table_;                   // of the rest: components of difference (i, j, k) from c ((n_1 i + j) n_2 + k) on
  int components_ = 6;
  std::vector<Pack> scratch_;
};

}  // namespace tanktread::stokes
