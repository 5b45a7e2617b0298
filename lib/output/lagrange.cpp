#include "output/lagrange.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"

namespace tanktread::output {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;

/// Bernstein polynomials of one direction at a place, and their derivatives.
struct Line {
  RowVectorXd value, first, second;
  Line(int p, double s) : value(p + 1), first(p + 1), second(p + 1) { spline::bernstein(p, s, value.data(), first.data(), second.data()); }
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

/// The three components at a node of a cell.
Vec3 three(const MatrixXd& cells, Eigen::Index element, Eigen::Index node) {
  const Eigen::Index n_e = cells.cols() / 3;
  return {cells(node, element), cells(node, n_e + element), cells(node, 2 * n_e + element)};
}

/// The normal of an element at node (i, j), moved by `inset` of the way to the middle.
Vec3 normal_inside(const surface::BezierMap& map, const Net& net, int element, const std::array<int, 2>& node, double inset) {
  const int p = map.degree(element);
  std::vector<double> points(3 * static_cast<std::size_t>(map.n_bezier(element)));
  map.points(element, net, points.data());
  const double s = double(node[0]) / p, t = double(node[1]) / p;
  const surface::Jet at = surface::jet({p, points.data()}, s + inset * (0.5 - s), t + inset * (0.5 - t));
  return at.s.cross(at.t);
}

}  // namespace

LagrangeMesh lagrange_mesh(const spline::Space& space, const Net& net) {
  LagrangeMesh mesh;
  std::vector<Vec3> places;
  std::vector<spline::Site> sites;
  mesh.offsets.push_back(0);
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const int p = space.elements[e].degree;
    const surface::ElementPoints points(space, net, static_cast<int>(e));
    for (const auto& [i, j] : node_order(p)) {
      sites.push_back({static_cast<int>(e), double(i) / p, double(j) / p});
      places.push_back(surface::place(points.patch(), sites.back().s, sites.back().t));
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

Nodes::Table::Table(int degree) {
  const auto order = node_order(degree);
  const auto n = static_cast<Eigen::Index>(order.size());
  for (MatrixXd* part : {&value, &s, &t, &ss, &st, &tt}) part->resize(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto [i, j] = order[static_cast<std::size_t>(k)];
    const Line along_s(degree, double(i) / degree), along_t(degree, double(j) / degree);
    value.row(k) = tensor(along_s.value, along_t.value);
    s.row(k) = tensor(along_s.first, along_t.value);
    t.row(k) = tensor(along_s.value, along_t.first);
    ss.row(k) = tensor(along_s.second, along_t.value);
    st.row(k) = tensor(along_s.first, along_t.first);
    tt.row(k) = tensor(along_s.value, along_t.second);
  }
}

Nodes::Nodes(const spline::Space& space, LagrangeMesh mesh) : mesh_(std::move(mesh)), map_(space), origins_(mesh_.sites.size()) {
  for (const surface::Block& block : map_.blocks().blocks) tables_.emplace_back(block.degree);
  // Backwards, so that the first element of a node has the last word: the one that `sites` names.
  for (int e = map_.n_elements() - 1; e >= 0; --e) {
    const auto [block, element] = map_.blocks().place[static_cast<std::size_t>(e)];
    const auto begin = static_cast<std::size_t>(mesh_.offsets[static_cast<std::size_t>(e)]);
    for (int k = map_.n_bezier(e) - 1; k >= 0; --k)
      origins_[static_cast<std::size_t>(mesh_.connectivity[begin + static_cast<std::size_t>(k)])] = {block, element, k};
  }
}

/// Shape (Bezier points, 3 n_e), component c of element k in column c n_e + k.
Nodes::Cells Nodes::bezier(const Net& net) const {
  Cells result(tables_.size());
  for (std::size_t b = 0; b < result.size(); ++b) map_.points(map_.blocks().blocks[b], net, result[b]);
  return result;
}

/// The same at the nodes of the cells.
Nodes::Cells Nodes::at_cells(const Cells& bezier, MatrixXd Table::*part) const {
  Cells result;
  for (std::size_t b = 0; b < bezier.size(); ++b) result.emplace_back(tables_[b].*part * bezier[b]);
  return result;
}

Net Nodes::values(const Net& control_values) const {
  const Cells cells = at_cells(bezier(control_values), &Table::value);
  Net result(static_cast<Eigen::Index>(origins_.size()), 3);
  for (std::size_t i = 0; i < origins_.size(); ++i) {
    const auto [block, element, node] = origins_[i];
    result.row(static_cast<Eigen::Index>(i)) = three(cells[static_cast<std::size_t>(block)], element, node).transpose();
  }
  return result;
}

std::vector<surface::Jet> Nodes::jets(const Net& net) const {
  std::vector<surface::Jet> result(origins_.size());
  const Cells points = bezier(net);
  const std::pair<MatrixXd Table::*, Vec3 surface::Jet::*> parts[] = {{&Table::value, &surface::Jet::x}, {&Table::s, &surface::Jet::s},
                                                                      {&Table::t, &surface::Jet::t},     {&Table::ss, &surface::Jet::ss},
                                                                      {&Table::st, &surface::Jet::st},   {&Table::tt, &surface::Jet::tt}};
  for (const auto& [part, of_jet] : parts) {
    const Cells cells = at_cells(points, part);
    for (std::size_t i = 0; i < origins_.size(); ++i) {
      const auto [block, element, node] = origins_[i];
      result[i].*of_jet = three(cells[static_cast<std::size_t>(block)], element, node);
    }
  }
  return result;
}

Net Nodes::normals(const Net& net) const {
  constexpr double kDegenerate = 1e-6;  // |a1 x a2| over |a1|_max |a2|_max of the element
  constexpr double kInset = 1e-4;
  const Cells points = bezier(net), along_s = at_cells(points, &Table::s), along_t = at_cells(points, &Table::t);
  Net sum = Net::Zero(static_cast<Eigen::Index>(mesh_.sites.size()), 3);
  for (int e = 0; e < map_.n_elements(); ++e) {
    const auto [block, element] = map_.blocks().place[static_cast<std::size_t>(e)];
    const MatrixXd &a1 = along_s[static_cast<std::size_t>(block)], &a2 = along_t[static_cast<std::size_t>(block)];
    const int n = map_.n_bezier(e);
    double longest_s = 0, longest_t = 0;
    for (int k = 0; k < n; ++k) {
      longest_s = std::max(longest_s, three(a1, element, k).squaredNorm());
      longest_t = std::max(longest_t, three(a2, element, k).squaredNorm());
    }
    const double least = kDegenerate * std::sqrt(longest_s * longest_t);
    const std::int64_t* node = mesh_.connectivity.data() + mesh_.offsets[static_cast<std::size_t>(e)];
    for (int k = 0; k < n; ++k) {
      Vec3 normal = three(a1, element, k).cross(three(a2, element, k));
      if (normal.norm() < least) normal = normal_inside(map_, net, e, node_order(map_.degree(e))[static_cast<std::size_t>(k)], kInset);
      sum.row(node[k]) += normal.normalized();
    }
  }
  sum.rowwise().normalize();
  return sum;
}

MatrixXd nodal_values(const spline::Space& space, const LagrangeMesh& mesh, const MatrixXd& control_values) {
  const Nodes nodes(space, mesh);
  MatrixXd result(static_cast<Eigen::Index>(mesh.sites.size()), control_values.cols());
  for (Eigen::Index c = 0; c < control_values.cols(); c += 3) {
    const Eigen::Index width = std::min<Eigen::Index>(3, control_values.cols() - c);
    Net three = Net::Zero(control_values.rows(), 3);
    three.leftCols(width) = control_values.middleCols(c, width);
    result.middleCols(c, width) = nodes.values(three).leftCols(width);
  }
  return result;
}

Net nodal_normals(const spline::Space& space, const LagrangeMesh& mesh, const Net& net) { return Nodes(space, mesh).normals(net); }

}  // namespace tanktread::output
