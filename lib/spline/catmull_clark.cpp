#include "spline/catmull_clark.hpp"

#include <cmath>

#include "spline/extraordinary_g1.hpp"
#include "spline/knots.hpp"

namespace tanktread::spline {

namespace {

using Ring = OneRing;
using Row = Eigen::Matrix<double, 1, Ring::size>;

/// Number in the ring of the lattice point (u, v), 0 .. 2, of sector j. A negative coordinate leads into the neighbouring sector.
int ring_point(int j, int u, int v) {
  if (v < 0) return ring_point(j + 2, -v, u);
  if (u < 0) return ring_point(j + 1, v, -u);
  j %= 3;
  const int next = (j + 1) % 3;
  if (u == 0 && v == 0) return Ring::P;
  if (v == 0) return (u == 1 ? Ring::E : Ring::A) + j;
  if (u == 0) return (v == 1 ? Ring::E : Ring::A) + next;
  if (u == 1) return (v == 1 ? Ring::F : Ring::D) + j;
  return (v == 1 ? Ring::B : Ring::C) + j;
}

Row coarse(int j, int u, int v) { return Row::Unit(ring_point(j, u, v)); }

/// Point of the subdivided net at (a, b) halves of a step in sector j.
Row fine(int j, int a, int b) {
  if (b < 0) return fine(j + 2, -b, a);
  if (a < 0) return fine(j + 1, b, -a);
  const int u = a >> 1, v = b >> 1;
  auto face = [&](int x, int y) -> Row {  // mean of the face with lower left corner (x, y)
    // To the left of and below the axes the corner nearest to the point lies on the spoke; ring_point takes care of the rest.
    return (coarse(j, x, y) + coarse(j, x + 1, y) + coarse(j, x + 1, y + 1) + coarse(j, x, y + 1)) / 4;
  };
  if ((a & 1) && (b & 1)) return face(u, v);
  if (a & 1) return (coarse(j, u, v) + coarse(j, u + 1, v) + face(u, v) + face(u, v - 1)) / 4;
  if (b & 1) return (coarse(j, u, v) + coarse(j, u, v + 1) + face(u, v) + face(u - 1, v)) / 4;
  if (a == 0 && b == 0) {
    Row Q = Row::Zero(), R = Row::Zero();
    for (int k = 0; k < 3; ++k) {
      Q += (coarse(k, 0, 0) + coarse(k, 1, 0) + coarse(k, 1, 1) + coarse(k, 0, 1)) / 12;
      R += (coarse(k, 0, 0) + coarse(k, 1, 0)) / 6;
    }
    return (Q + 2 * R) / 3;
  }
  const Row P = coarse(j, u, v);
  const Row Q = (face(u, v) + face(u - 1, v) + face(u, v - 1) + face(u - 1, v - 1)) / 4;
  const Row R = (4 * P + coarse(j, u + 1, v) + coarse(j, u - 1, v) + coarse(j, u, v + 1) + coarse(j, u, v - 1)) / 8;
  return (Q + 2 * R + P) / 4;
}

/// Bezier points (16, 19) of the fine element [a, a + 1] x [b, b + 1] (halves of a step) of sector 0, a uniform bicubic.
Eigen::MatrixXd quarter(int a, int b) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(16, Ring::size);
  const std::array<double, 5> uniform{-2, -1, 0, 1, 2};
  for (int q = 0; q < 4; ++q)
    for (int p = 0; p < 4; ++p) {
      const Row point = fine(0, a + p - 1, b + q - 1);
      const auto s = b_spline_on(uniform, 1 - p, 2 - p), t = b_spline_on(uniform, 1 - q, 2 - q);
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) out.row(4 * j + i) += s[i] * t[j] * point;
    }
  return out;
}

}  // namespace

Eigen::MatrixXd catmull_clark_subdivision() {
  Eigen::MatrixXd A(Ring::size, Ring::size);
  for (int j = 0; j < 3; ++j)
    for (int v = 0; v <= 2; ++v)
      for (int u = 0; u <= 2; ++u) A.row(ring_point(j, u, v)) = fine(j, u, v);
  return A;
}

std::vector<Piece> catmull_clark_pieces(int depth) {
  std::vector<Piece> pieces;
  const Eigen::MatrixXd A = catmull_clark_subdivision();
  Eigen::MatrixXd ring = Eigen::MatrixXd::Identity(Ring::size, Ring::size);
  const std::array<std::array<int, 2>, 3> corner{{{1, 0}, {1, 1}, {0, 1}}};
  double size = 0.5;
  for (int m = 0; m < depth; ++m, size /= 2) {
    for (const auto& c : corner) pieces.push_back({c[0] * size, c[1] * size, size, (quarter(c[0], c[1]) * ring).transpose()});
    ring = A * ring;
  }
  pieces.push_back({0, 0, 2 * size, (averaged_bicubic() * ring).transpose()});
  return pieces;
}

}  // namespace tanktread::spline
