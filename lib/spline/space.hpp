#pragma once
// The one thing that everything downstream of the spline room sees: a list of Bezier elements and the collocation points.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace tanktread::spline {

/// One Bezier element: the unit square (s, t), a tensor-product Bernstein basis, and the functions of the spline space on it.
///
///   N_A(s, t) = sum_b extraction(A, b) B_b(s, t),   b = (p + 1) j + i,  B_b = B_i(s) B_j(t)
///
/// Right-handed: x_,s x x_,t points out of a closed surface, and from a tube's wall into the fluid.
struct Element {
  int degree = 3;              ///< p, the same in s and t: 3, or 4 around an extraordinary point under `g1`; 2 to 6 from a file
  std::vector<int> points;     ///< control-point ids, m of them (16 on a regular element)
  /// Shape (m, (p + 1)^2); every column sums to 1. Elements that are alike, as in copies of a space, may share one.
  std::shared_ptr<const Eigen::MatrixXd> extraction;
  int face = 0;                ///< placement in the T-mesh: macro face, lower left corner and size, in sides of the face
  std::array<double, 2> origin{0, 0}, size{1, 1};
};

/// A place on the surface: an element and its local coordinates in [0, 1]^2.
struct Site {
  int element = 0;
  double s = 0, t = 0;
};

/// A spline space on a surface, closed but for a tube's wall: control points 0 .. n_points-1, one generalised Greville site for each.
struct Space {
  int n_points = 0;
  std::vector<Element> elements;
  /// For collocation point i, every element whose closure holds it, with its coordinates there; the first is the one to evaluate on.
  std::vector<std::vector<Site>> collocation;
  std::string description;  ///< one line for the plan: mesh, degree, extraordinary points or poles
};

/// Where one of several spaces lies in the space of all: control points (and collocation points) first_point .. first_point + n_points - 1, elements
/// first_element .. first_element + n_elements - 1.
struct Block {
  int first_point = 0, n_points = 0;
  int first_element = 0, n_elements = 0;

  /// Its rows of a net of all.
  auto rows(Net& net) const { return net.middleRows(first_point, n_points); }
  auto rows(const Net& net) const { return net.middleRows(first_point, n_points); }
  bool holds(int point) const { return point >= first_point && point < first_point + n_points; }
};

/// The blocks of spaces that lie one after the other in their order.
std::vector<Block> blocks(std::span<const Space* const> spaces);

/// The space of all of them: Gamma = Gamma_1 + Gamma_2 + …, each as it was.
Space stacked(std::span<const Space* const> spaces);

/// From now on extraction matrices that are equal to the last bit are one matrix, within each of the spaces and across them.
void share_extraction(std::span<Space* const> spaces);

/// The block that is the whole of one space.
Block whole(const Space& space);

}  // namespace tanktread::spline
