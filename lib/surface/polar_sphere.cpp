#include "surface/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"

namespace tanktread::surface {
namespace {

/// Rows of control points; each row is a circle about the axis. Control point A belongs to row k = row[A]. Its position is profile[2 k] times
/// across[A] in the plane normal to the axis, and profile[2 k + 1] along the axis. across[A] is a vector of length 1, except at a C1 pole.
struct Circles {
  std::vector<int> row;
  std::vector<Eigen::Vector2d> across;
  int n_rows = 0;

  explicit Circles(const spline::PolarMesh& mesh) {
    double last = -1;
    for (const spline::PolarAnchor& anchor : spline::polar_anchors(mesh)) {
      n_rows += anchor.u != last;
      last = anchor.u;
      row.push_back(n_rows - 1);
      const double angle = 2 * std::numbers::pi * anchor.v / mesh.azimuthal;
      across.push_back(anchor.distance * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  }

  Net net(const Eigen::VectorXd& profile) const {
    Net x(row.size(), 3);
    for (std::size_t a = 0; a < row.size(); ++a) {
      const double radius = profile[2 * row[a]];
      x.row(a) << radius * across[a][0], radius * across[a][1], profile[2 * row[a] + 1];
    }
    return x;
  }
};

/// Returns the profile (radii and heights of the rows) of points on the sphere at evenly spaced colatitudes.
Eigen::VectorXd first_profile(const spline::PolarMesh& mesh) {
  std::vector<double> profile;
  double last = -1;
  for (const spline::PolarAnchor& anchor : spline::polar_anchors(mesh)) {
    if (anchor.u == last) continue;
    last = anchor.u;
    const double colatitude = std::numbers::pi * anchor.u / mesh.meridional;
    profile.push_back(std::sin(colatitude));
    profile.push_back(-std::cos(colatitude));
  }
  return Eigen::Map<Eigen::VectorXd>(profile.data(), Eigen::Index(profile.size()));
}

/// Misfit of a surface to the unit sphere, with its gradient and Gauss-Newton matrix with respect to the profile. The misfit is the integral of |grad
/// eps|^2 + eps^2, with eps = (|x|^2 - 1)/2, over one sector between two meridians. All sectors are equal.
struct Misfit {
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd matrix;
};

class Sector {
 public:
  Sector(const spline::PolarMesh& mesh, const spline::Space& space) : circles_(mesh), one_at_pole_(spline::properties(mesh.poles).points == 1) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(6);
    for (const spline::Element& e : space.elements) {
      if (e.origin[0] != 0) continue;
      for (int q = 0; q < rule.size(); ++q) nodes_.push_back({&e, spline::basis(e, rule.s[q], rule.t[q], 1), rule.weights[q]});
    }
  }

  const Circles& circles() const { return circles_; }

  Misfit misfit(const Eigen::VectorXd& profile) const {
    const Eigen::Index n = profile.size();
    Misfit m{0, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
    const Net net = circles_.net(profile);
    for (const Node& node : nodes_) add(node, net, m);
    if (one_at_pole_)
      for (const Eigen::Index k : {Eigen::Index(0), n - 2}) {  // the control points of the poles stay on the axis
        m.matrix.row(k).setZero(), m.matrix.col(k).setZero();
        m.matrix(k, k) = 1, m.gradient[k] = 0;
      }
    return m;
  }

 private:
  struct Node {
    const spline::Element* element;
    spline::Basis basis;
    double weight;
  };

  void add(const Node& node, const Net& net, Misfit& m) const {
    const std::vector<int>& points = node.element->points;
    const spline::Basis& b = node.basis;
    Vec3 x = Vec3::Zero(), xs = Vec3::Zero(), xt = Vec3::Zero();
    int first = circles_.n_rows, last = 0;
    for (std::size_t a = 0; a < points.size(); ++a) {
      const Vec3 point = net.row(points[a]).transpose();
      const Eigen::Index k = Eigen::Index(a);
      x += b.value[k] * point, xs += b.s[k] * point, xt += b.t[k] * point;
      first = std::min(first, circles_.row[points[a]]), last = std::max(last, circles_.row[points[a]]);
    }
    Eigen::Matrix2d metric;
    metric << xs.dot(xs), xs.dot(xt), xs.dot(xt), xt.dot(xt);
    const double weight = node.weight * std::sqrt(metric.determinant());
    const Eigen::Matrix2d root = metric.inverse().llt().matrixL().transpose();

    // `residual`: eps = (|x|^2 - 1)/2, then the gradient of eps in an orthonormal frame of the tangent plane. `slope`: derivatives of `residual` with
    // respect to the radii and heights of the circles first .. last of control points.
    Vec3 residual;
    residual << (x.squaredNorm() - 1) / 2, root * Eigen::Vector2d(x.dot(xs), x.dot(xt));
    const int width = 2 * (last - first + 1);
    Eigen::Matrix<double, 3, Eigen::Dynamic> slope = Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, width);
    for (std::size_t a = 0; a < points.size(); ++a) {
      const Eigen::Index k = Eigen::Index(a);
      const Eigen::Vector2d& across = circles_.across[points[a]];
      const Vec3 directions[2] = {{across[0], across[1], 0}, Vec3::UnitZ()};
      for (int c = 0; c < 2; ++c) {
        const Vec3& d = directions[c];
        const double value = x.dot(d), in_s = xs.dot(d), in_t = xt.dot(d);
        slope.col(2 * (circles_.row[points[a]] - first) + c) +=
            Vec3(b.value[k] * value, in_s * b.value[k] + value * b.s[k], in_t * b.value[k] + value * b.t[k]);
      }
    }
    slope.bottomRows(2) = (root * slope.bottomRows(2)).eval();
    m.value += weight * residual.squaredNorm();
    m.gradient.segment(2 * first, width) += weight * slope.transpose() * residual;
    m.matrix.block(2 * first, 2 * first, width, width) += weight * slope.transpose() * slope;
  }

  Circles circles_;
  bool one_at_pole_;  // true if each pole has one control point, false if it has three
  std::vector<Node> nodes_;
};

}  // namespace

Net unit_sphere(const spline::PolarMesh& mesh, const spline::Space& space, int axis) {
  const Sector sector(mesh, space);
  Eigen::VectorXd profile = first_profile(mesh), best = profile;
  double least = std::numeric_limits<double>::infinity();
  // Each row of control points is a circle about the axis. Moving rows along the meridian hardly changes the misfit, so the damping of the
  // Gauss-Newton steps must be nearly zero to find the best distribution of rows. Long steps along the tangents move rows off the sphere, by the
  // square of the step; the next step corrects this. But if rows are closer together than the points within a row, a long step may fold the surface.
  // In this case, the length of the step is limited.
  const double longest = mesh.meridional > mesh.azimuthal ? 0.2 : std::numeric_limits<double>::infinity();
  double damping = 1e-12;
  for (int k = 0; k < 30; ++k) {
    const Misfit at = sector.misfit(profile);
    if (at.value < least) least = at.value, best = profile;
    Eigen::VectorXd step;
    for (;; damping *= 100) {
      Eigen::MatrixXd damped = at.matrix;
      damped.diagonal().array() += damping * at.matrix.diagonal().maxCoeff();
      step = damped.ldlt().solve(at.gradient);
      if (step.norm() < longest || damping > 1) break;
    }
    profile -= step;
    if (step.norm() < 1e-6 * profile.norm()) break;
  }
  const Net upright = sector.circles().net(best);
  Net net(upright.rows(), 3);
  for (int c = 0; c < 3; ++c) net.col((axis + 1 + c) % 3) = upright.col(c);
  return net;
}

}  // namespace tanktread::surface
