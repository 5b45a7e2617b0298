#pragma once
// Interface of a spline space to all other modules: a list of Bezier elements and the collocation points.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace tanktread::spline {

/// A Bezier element: the unit square (s, t), a tensor-product Bernstein basis, and the functions of the spline space on it.
///
///   N_A(s, t) = sum_b extraction(A, b) B_b(s, t),   b = (p + 1) j + i,  B_b = B_i(s) B_j(t)
///
/// The element is right-handed: the cross product of dx/ds and dx/dt points out of a closed surface, and from the wall of a tube into the fluid.
struct Element {
  int degree = 3;              ///< degree p in s and t: 3, or 4 around an extraordinary point with `g1`, or 2 to 6 from a file
  std::vector<int> points;     ///< indices of the m control points (16 on a regular element)
  /// Extraction matrix, shape (m, (p + 1)^2). Every column sums to 1. Equal elements, for example in copies of a space, may share one matrix.
  std::shared_ptr<const Eigen::MatrixXd> extraction;
  int face = 0;                                    ///< index of the macro face (face of the cube) that contains the element
  std::array<double, 2> origin{0, 0}, size{1, 1};  ///< lower left corner and size of the element, in units of the side of the macro face
};

/// A parametric point of the surface: an element and local coordinates in [0, 1]^2.
struct Site {
  int element = 0;
  double s = 0, t = 0;
};

/// A spline space on a surface with control points 0 .. n_points-1 and one generalised Greville point for each control point. The surface is closed,
/// except for the wall of a tube.
struct Space {
  int n_points = 0;
  std::vector<Element> elements;
  /// Collocation points. Each is given by its sites (element, local coordinates) on all elements whose closure contains it. Values are
  /// evaluated at the first site.
  std::vector<std::vector<Site>> collocation;
  std::string description;  ///< one line for the printed plan of a run: mesh, degree, extraordinary points or poles
};

/// Index ranges of one space in a stacked space: its control points (and collocation points) are first_point .. first_point + n_points - 1, and its
/// elements are first_element .. first_element + n_elements - 1.
struct Block {
  int first_point = 0, n_points = 0;
  int first_element = 0, n_elements = 0;

  /// Returns the rows of a net of the stacked space that belong to this space.
  auto rows(Net& net) const { return net.middleRows(first_point, n_points); }
  auto rows(const Net& net) const { return net.middleRows(first_point, n_points); }
  bool contains(int point) const { return point >= first_point && point < first_point + n_points; }
  bool contains_element(int element) const { return element >= first_element && element < first_element + n_elements; }
};

/// Returns the index ranges of spaces that are stacked in the given order.
std::vector<Block> blocks(std::span<const Space* const> spaces);

/// Returns the stacked space: the spaces on the surface Gamma = Gamma_1 + Gamma_2 + …, with unchanged functions and only their indices shifted.
Space stacked(std::span<const Space* const> spaces);

/// Makes elements with bitwise equal extraction matrices share one matrix, within each of the spaces and between them.
void share_extraction(std::span<Space* const> spaces);

/// Returns the index range that contains a whole space.
Block whole(const Space& space);

}  // namespace tanktread::spline
