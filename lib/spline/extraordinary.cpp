#include "spline/extraordinary.hpp"

#include <array>
#include <vector>

#include <Eigen/Dense>
#include <unsupported/Eigen/KroneckerProduct>

#include "spline/bernstein.hpp"

namespace tanktread::spline {

namespace {

using Ring = OneRing;
using Row = Eigen::Matrix<double, 1, Ring::size>;
constexpr int N = 3;

Row unit(int point) { return Row::Unit(point); }

/// Rotates a row of coefficients of the 19 control points (OneRing) from face 0 to face j about the extraordinary point.
Row turned_row(const Row& r, int j) {
  Row out = r;
  for (int group = 1; group < Ring::size; group += N)
    for (int i = 0; i < N; ++i) out[group + (i + j) % N] = r[group + i];
  return out;
}

/// Returns the Bezier point inside a face that is next to the corner `near`, as the weighted mean of the four corners of the face (weights of
/// uniform cubic B-splines).
Row inner(const Row& near, const Row& next, const Row& opposite, const Row& last) {
  return (4 * near + 2 * next + opposite + 2 * last) / 9;
}

/// Returns control point (u, v) of the 4 x 4 net that determines the bicubic patch on face 0, as a unit row; u and v are 0 .. 3. At the corners of
/// face 0, u and v are 1 or 2; (1, 1) is the extraordinary point. Point (0, 0) does not exist, because only three faces meet there.
Row net(int u, int v) {
  using R = Ring;
  static const int id[4][4] = {{-1, R::E + 2, R::F + 1, R::B + 1},
                               {R::E + 2, R::P, R::E + 1, R::A + 1},
                               {R::F + 2, R::E + 0, R::F + 0, R::D + 0},
                               {R::D + 2, R::A + 0, R::B + 0, R::C + 0}};
  return unit(id[u][v]);
}

}  // namespace

Eigen::MatrixXd averaged_bicubic() {
  // Returns the inner Bezier point of the face [u, u+1] x [v, v+1] of the control net that is nearest to the corner (u + cu, v + cv) of the face.
  auto near_corner = [](int u, int v, int cu, int cv) {
    return inner(net(u + cu, v + cv), net(u + 1 - cu, v + cv), net(u + 1 - cu, v + 1 - cv), net(u + cu, v + 1 - cv));
  };
  Eigen::MatrixXd out(16, Ring::size);
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 4; ++u) {
      Row sum = Row::Zero();
      if (u == 0 && v == 0) {
        for (int j = 0; j < N; ++j) sum += turned_row(near_corner(1, 1, 0, 0), j) / N;
      } else {
        // A Bezier point on a side of a face is the mean of the two nearest Bezier points inside the adjacent faces. A Bezier point at a corner is
        // the mean of the four nearest ones.
        struct Inner {
          int face, corner;
        };
        auto sides = [](int i) -> std::vector<Inner> {
          if (i == 0) return {{0, 1}, {1, 0}};
          if (i == 3) return {{1, 1}, {2, 0}};
          return {{1, i - 1}};
        };
        const auto us = sides(u), vs = sides(v);
        for (const auto& a : us)
          for (const auto& b : vs) sum += near_corner(a.face, b.face, a.corner, b.corner) / double(us.size() * vs.size());
      }
      out.row(4 * v + u) = sum;
    }
  return out;
}

namespace {

constexpr double w0 = -1;  // 2 cos(2 pi / 3)

// Unknowns: the changes of Bezier point c1 of each spoke (mesh line from the extraordinary point), and of the inner points (v, u) = 11, 12, 21, 22
// of each face.
enum { c1, b11, b12, b21, b22, kinds };
constexpr int unknowns = kinds * N;
int unknown(int kind, int j) { return kinds * ((j + N) % N) + kind; }

/// Returns the Bezier points of the surface `bicubic` after degree elevation from 3 to 4. Row 5 v + u is Bezier point (u, v).
Eigen::MatrixXd raised(const Eigen::MatrixXd& bicubic) {
  const Eigen::MatrixXd up = elevation(3, 4);
  return Eigen::MatrixXd(Eigen::kroneckerProduct(up, up)) * bicubic;
}

/// Linear conditions G x = g that make tangent planes continuous (G1) across the three mesh lines from the extraordinary point (spokes). x: changes
/// of the Bezier points. There are three conditions per spoke.
struct Conditions {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(3 * N, unknowns), g = Eigen::MatrixXd(3 * N, Ring::size);
};
Conditions conditions(const Eigen::MatrixXd& bicubic, const Eigen::MatrixXd& biquartic) {
  std::array<Row, N> s0, s1, s2, s3;  // Bezier points c0 .. c3 of the boundary curve along each spoke (mesh line from the extraordinary point), as
                                      // rows of coefficients
  for (int j = 0; j < N; ++j) {
    s0[j] = turned_row(bicubic.row(0), j);
    s1[j] = turned_row(bicubic.row(1), j);
    s2[j] = turned_row(bicubic.row(2), j);
    s3[j] = turned_row(bicubic.row(3), j);
  }
  const auto old = [&](int v, int u, int j) { return turned_row(biquartic.row(5 * v + u), j % N); };
  Conditions out;
  auto& [G, g] = out;
  for (int j = 0; j < N; ++j) {
    const int left = (j + N - 1) % N, right = (j + 1) % N;
    G(3 * j, unknown(c1, left)) += 1;
    G(3 * j, unknown(c1, right)) += 1;
    G(3 * j, unknown(c1, j)) += -w0;
    g.row(3 * j) = (2 - w0) * s0[j] - (s1[left] + s1[right] - w0 * s1[j]);

    G(3 * j + 1, unknown(b11, j)) += 1;
    G(3 * j + 1, unknown(b11, left)) += 1;
    G(3 * j + 1, unknown(c1, j)) += -1.5 + 3 * w0 / 8;
    g.row(3 * j + 1) = (s0[j] + 3 * s1[j]) / 2 + 3 * w0 / 8 * (s2[j] - s1[j]) - old(1, 1, j) - old(1, 1, left);

    G(3 * j + 2, unknown(b12, j)) += 1;
    G(3 * j + 2, unknown(b21, left)) += 1;
    G(3 * j + 2, unknown(c1, j)) += -1;
    g.row(3 * j + 2) = s1[j] + s2[j] + w0 / 8 * (s3[j] - s2[j]) - old(1, 2, j) - old(2, 1, left);
  }
  return out;
}

/// Returns the row of coefficients whose product with the unknowns is the change of the Bezier point (v, u) of face j, 0 <= u, v <= 4.
Eigen::RowVectorXd change(int v, int u, int j) {
  Eigen::RowVectorXd d = Eigen::RowVectorXd::Zero(unknowns);
  if (v == 0 && (u == 1 || u == 2)) d[unknown(c1, j)] = u == 1 ? 0.75 : 0.5;
  if (u == 0 && (v == 1 || v == 2)) d[unknown(c1, j + 1)] = v == 1 ? 0.75 : 0.5;
  if (u >= 1 && u <= 2 && v >= 1 && v <= 2) d[unknown(v == 1 ? (u == 1 ? b11 : b12) : (u == 1 ? b21 : b22), j)] = 1;
  return d;
}

/// Returns the matrix L of differences between the changes of neighbouring Bezier points on all faces. The discrete Dirichlet energy of the changes
/// x is |L x|^2.
Eigen::MatrixXd differences() {
  Eigen::MatrixXd L(N * 40, unknowns);
  int row = 0;
  for (int j = 0; j < N; ++j)
    for (int a = 0; a < 5; ++a)
      for (int b = 0; b < 4; ++b) {
        L.row(row++) = change(a, b + 1, j) - change(a, b, j);
        L.row(row++) = change(b + 1, a, j) - change(b, a, j);
      }
  return L;
}

/// Returns the x that minimises |L x| subject to G x = g (`on`), as a particular solution plus an element of the kernel of G.
Eigen::MatrixXd least(const Eigen::MatrixXd& L, const Conditions& on) {
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(on.G);
  const Eigen::MatrixXd kernel = lu.kernel(), particular = lu.solve(on.g);
  const Eigen::MatrixXd LZ = L * kernel;
  return particular - kernel * (LZ.transpose() * LZ).ldlt().solve(LZ.transpose() * (L * particular));
}

}  // namespace

Eigen::MatrixXd constrained_biquartic() {
  const Eigen::MatrixXd bicubic = averaged_bicubic();
  Eigen::MatrixXd biquartic = raised(bicubic);
  const Eigen::MatrixXd x = least(differences(), conditions(bicubic, biquartic));
  for (int v = 0; v < 5; ++v)
    for (int u = 0; u < 5; ++u) biquartic.row(5 * v + u) += change(v, u, 0) * x;
  return biquartic;
}

namespace {

/// Returns the index in OneRing of the control point (u, v), u, v = 0 .. 2, of sector j (the face between spokes j and j + 1). A negative
/// coordinate refers to the neighbouring sector.
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

/// Returns control point (a, b) of sector j (the face between the mesh lines j and j + 1 from the extraordinary point) after one subdivision. a and b
/// count half spacings of the original control net along these two mesh lines.
Row fine(int j, int a, int b) {
  if (b < 0) return fine(j + 2, -b, a);
  if (a < 0) return fine(j + 1, b, -a);
  const int u = a >> 1, v = b >> 1;
  auto face = [&](int x, int y) -> Row {  // mean of the four control points of the face whose lower left corner is (x, y)
    // If x or y is -1, the face is in the neighbouring sector, whose control points ring_point() finds.
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

/// Returns the Bezier extraction matrix, shape (16, 19), of the element [a, a + 1] x [b, b + 1] of sector 0. Row 4 j + i contains the coefficients of
/// Bezier point (i, j) with respect to the 19 control points of OneRing. The integers a and b count half spacings of the original control net, as in
/// fine(). The subdivided control net is regular around this element.
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
