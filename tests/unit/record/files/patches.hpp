#pragma once
// Small open surfaces of separate Bezier patches, each with its own control points, that interpolate given functions.

#include <functional>

#include <Eigen/LU>

#include "base/types.hpp"
#include "spline/bernstein.hpp"
#include "spline/space.hpp"

namespace tanktread::output {

using Map = std::function<Vec3(double, double)>;  ///< position as a function of (s, t), a polynomial of the element's degree in each variable

/// Adds an element of degree p that represents `map`, by interpolation at (p + 1)^2 uniform points.
inline void add_patch(spline::Space& space, Net& net, int p, const Map& map) {
  const int n = p + 1;
  Eigen::MatrixXd line(n, n);
  for (int i = 0; i < n; ++i) {
    Eigen::VectorXd row(n);
    spline::bernstein(p, double(i) / p, row.data());
    line.row(i) = row;
  }
  Eigen::MatrixXd table(n * n, n * n), values(n * n, 3);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      for (int b = 0; b < n * n; ++b) table(j * n + i, b) = line(i, b % n) * line(j, b / n);
      values.row(j * n + i) = map(double(i) / p, double(j) / p).transpose();
    }
  spline::Element element;
  element.degree = p;
  element.extraction = std::make_shared<const Eigen::MatrixXd>(Eigen::MatrixXd::Identity(n * n, n * n));
  for (int b = 0; b < n * n; ++b) element.points.push_back(space.n_points + b);
  space.elements.push_back(element);
  space.n_points += n * n;
  net.conservativeResize(space.n_points, 3);
  net.bottomRows(n * n) = table.partialPivLu().solve(values);
}

}  // namespace tanktread::output
