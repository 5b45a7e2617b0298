#include "surface/bezier_points.hpp"

#include <map>

#include "base/kept_once.hpp"
#include "surface/three_sums.hpp"

namespace tanktread::surface {
namespace {

/// Buffer for n numbers. Allocates heap memory only if n is above 3 * 64, the number of coordinates of 64 control points.
struct Room {
  explicit Room(int n) {
    if (n <= most) return;
    larger.resize(n);
    numbers = larger.data();
  }

  static constexpr int most = 3 * 64;
  double usual[most];
  std::vector<double> larger;
  double* numbers = usual;
};

}  // namespace

std::vector<DegreeGroup> groups_by_degree(const spline::Space& space) {
  std::map<int, std::vector<int>> of_degree;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) of_degree[space.elements[e].degree].push_back(e);
  std::vector<DegreeGroup> groups;
  for (auto& [degree, elements] : of_degree) groups.push_back({degree, std::move(elements)});
  return groups;
}

BezierMap::BezierMap(const spline::Space& space) : n_points_(space.n_points), groups_(groups_by_degree(space)) {
  Tables tables;
  for (const spline::Element& element : space.elements) {
    const Eigen::MatrixXd& c = *element.extraction;
    const std::size_t first = by_bezier_.size();
    by_bezier_.insert(by_bezier_.end(), c.data(), c.data() + c.size());
    const std::size_t operation = kept_once(by_bezier_, first, tables);
    if (operation == first) {
      by_function_.resize(by_bezier_.size());
      Eigen::Map<Eigen::MatrixXd>(&by_function_[first], c.cols(), c.rows()) = c.transpose();
    }
    elements_.push_back({element.degree, static_cast<int>(element.points.size()), static_cast<int>(points_.size()), operation});
    points_.insert(points_.end(), element.points.begin(), element.points.end());
  }
}

void BezierMap::points(int element, const Net& net, double* out) const {
  const auto& [degree, m, first, operation] = elements_[element];
  const int* ids = points_.data() + first;
  Room control(3 * m);
  for (int a = 0; a < m; ++a)
    for (int c = 0; c < 3; ++c) control.numbers[c * m + a] = net.data()[3 * ids[a] + c];
  three_sums(n_bezier(element), m, &by_function_[operation], control.numbers, out);
}

void BezierMap::add_transposed(int element, const double* in, Net& net) const {
  std::vector<double> rows;
  transposed(element, in, rows);
  add_rows(element, rows, net);
}

void BezierMap::transposed(int element, const double* in, std::vector<double>& rows) const {
  rows.resize(3 * static_cast<std::size_t>(elements_[element].functions));
  three_sums(elements_[element].functions, n_bezier(element), &by_bezier_[elements_[element].operation], in, rows.data());
}

void BezierMap::add_rows(int element, const std::vector<double>& rows, Net& net) const {
  const int m = elements_[element].functions, *ids = points_.data() + elements_[element].first;
  for (int a = 0; a < m; ++a)
    for (int c = 0; c < 3; ++c) net(ids[a], c) += rows[static_cast<std::size_t>(c * m + a)];
}

}  // namespace tanktread::surface
