#include "output/lagrange.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"

namespace tanktread::output {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;

/// Bernstein polynomials of one direction at a place, and their slopes.
struct Line {
  RowVectorXd values, slopes;
  Line(int p, double s) : values(p + 1), slopes(p + 1) { spline::bernstein(p, s, values.data(), slopes.data(), nullptr); }
};

/// Tensor product of a row in s and one in t, s fastest.
RowVectorXd tensor(const RowVectorXd& s, const RowVectorXd& t) {
  RowVectorXd result(s.size() * t.size());
  for (Eigen::Index j = 0; j < t.size(); ++j) result.segment(j * s.size(), s.size()) = t[j] * s;
  return result;
}

/// (i, j) of the nodes of a cell in VTK's order.
std::vector<std::array<int, 2>> node_order(int p) {
  std::vector<std::array<int, 2>> nodes{{0, 0}, {p, 0}, {p, p}, {0, p}};
  for (int i = 1; i < p; ++i) nodes.push_back({i, 0});
  for (int j = 1; j < p; ++j) nodes.push_back({p, j});
  for (int i = 1; i < p; ++i) nodes.push_back({i, p});
  for (int j = 1; j < p; ++j) nodes.push_back({0, j});
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p; ++i) nodes.push_back({i, j});
  return nodes;
}

/// Bernstein rows at the nodes of a cell: values, and slopes in s and t taken at the place shrunk towards the middle by `inset`.
struct Table {
  std::vector<std::array<int, 2>> order;
  MatrixXd values;
  MatrixXd s_slopes, t_slopes;
};

Table table(int p, double inset) {
  Table result{node_order(p), {}, {}, {}};
  const auto n = static_cast<Eigen::Index>(result.order.size());
  result.values.resize(n, n);
  result.s_slopes.resize(n, n);
  result.t_slopes.resize(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto [i, j] = result.order[static_cast<std::size_t>(k)];
    const double s = double(i) / p, t = double(j) / p;
    result.values.row(k) = tensor(Line(p, s).values, Line(p, t).values);
    const Line in_s(p, s + inset * (0.5 - s)), in_t(p, t + inset * (0.5 - t));
    result.s_slopes.row(k) = tensor(in_s.slopes, in_t.values);
    result.t_slopes.row(k) = tensor(in_s.values, in_t.slopes);
  }
  return result;
}

/// Tables by degree, made once a call.
class Tables {
 public:
  explicit Tables(double inset = 0) : inset_(inset) {}
  const Table& of(int p) {
    const auto it = tables_.find(p);
    return it != tables_.end() ? it->second : tables_.emplace(p, table(p, inset_)).first->second;
  }

 private:
  double inset_;
  std::map<int, Table> tables_;
};

/// Bezier values of an element, shape ((p + 1)^2, k).
template <class Field>
MatrixXd bezier(const spline::Element& element, const Field& control_values) {
  return element.extraction.transpose() * control_values(element.points, Eigen::all);
}

/// For each place, the first of all places that coincide with it. They are swept along a direction that no symmetry of a mesh has, so
/// that few come near one another.
std::vector<std::size_t> first_of_equals(const std::vector<Vec3>& places) {
  const Vec3 direction(0.8137, 0.4691, 0.3433);
  double size = 0;
  std::vector<double> along;
  for (const Vec3& x : places) {
    along.push_back(direction.dot(x));
    size = std::max(size, (x - places.front()).norm());
  }
  const double tolerance = 1e-9 * size;
  std::vector<std::size_t> order(places.size()), first(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return along[k]; });
  std::iota(first.begin(), first.end(), 0);
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a; b-- > 0 && along[order[a]] - along[order[b]] <= tolerance;)
      if ((places[order[a]] - places[order[b]]).norm() <= tolerance) {
        const std::size_t low = std::min(first[order[a]], first[order[b]]);
        first[order[a]] = first[order[b]] = low;
      }
  for (std::size_t& k : first)
    while (first[k] != k) k = first[k];
  return first;
}

}  // namespace

LagrangeMesh lagrange_mesh(const spline::Space& space, const Net& net) {
  LagrangeMesh mesh;
  Tables tables;
  std::vector<Vec3> places;
  std::vector<spline::Site> sites;
  mesh.offsets.push_back(0);
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const auto& element = space.elements[e];
    const Table& at = tables.of(element.degree);
    const MatrixXd x = at.values * bezier(element, net);
    for (std::size_t k = 0; k < at.order.size(); ++k) {
      places.push_back(x.row(static_cast<Eigen::Index>(k)).transpose());
      sites.push_back({static_cast<int>(e), double(at.order[k][0]) / element.degree, double(at.order[k][1]) / element.degree});
    }
    mesh.offsets.push_back(static_cast<std::int64_t>(places.size()));
  }
  const std::vector<std::size_t> first = first_of_equals(places);
  std::vector<std::int64_t> number(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (first[k] == k) {
      number[k] = static_cast<std::int64_t>(mesh.sites.size());
      mesh.sites.push_back(sites[k]);
    }
    mesh.connectivity.push_back(number[first[k]]);
  }
  return mesh;
}

Eigen::MatrixXd nodal_values(const spline::Space& space, const LagrangeMesh& mesh, const Eigen::MatrixXd& control_values) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(mesh.sites.size()), control_values.cols());
  Tables tables;
  // Backwards, so that the first element of a node has the last word: the one that `sites` names.
  for (std::size_t e = space.elements.size(); e-- > 0;) {
    const auto& element = space.elements[e];
    const MatrixXd values = tables.of(element.degree).values * bezier(element, control_values);
    for (Eigen::Index k = 0; k < values.rows(); ++k)
      result.row(mesh.connectivity[static_cast<std::size_t>(mesh.offsets[e] + k)]) = values.row(k);
  }
  return result;
}

Net nodal_normals(const spline::Space& space, const LagrangeMesh& mesh, const Net& net) {
  constexpr double kDegenerate = 1e-6;  // |a1 x a2| over |a1|_max |a2|_max of the element
  constexpr double kInset = 1e-4;
  Net sum = Net::Zero(static_cast<Eigen::Index>(mesh.sites.size()), 3);
  Tables tables, inside(kInset);
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const auto& element = space.elements[e];
    const MatrixXd control = bezier(element, net);
    const Table& at = tables.of(element.degree);
    const MatrixXd a1 = at.s_slopes * control, a2 = at.t_slopes * control;
    const double scale = a1.rowwise().norm().maxCoeff() * a2.rowwise().norm().maxCoeff();
    for (Eigen::Index k = 0; k < a1.rows(); ++k) {
      Vec3 n = Vec3(a1.row(k)).cross(Vec3(a2.row(k)));
      if (n.norm() < kDegenerate * scale) {
        const Table& in = inside.of(element.degree);
        n = Vec3(in.s_slopes.row(k) * control).cross(Vec3(in.t_slopes.row(k) * control));
      }
      sum.row(mesh.connectivity[static_cast<std::size_t>(mesh.offsets[e] + k)]) += n.normalized();
    }
  }
  sum.rowwise().normalize();
  return sum;
}

}  // namespace tanktread::output
