#include "surface/bezier_points.hpp"

#include <map>

#include "surface/three_sums.hpp"

namespace tanktread::surface {
namespace {

/// Room for n numbers, without an allocation where they are as few as usual.
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

std::vector<Block> blocks_by_degree(const spline::Space& space) {
  std::map<int, std::vector<int>> of_degree;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) of_degree[space.elements[e].degree].push_back(e);
  std::vector<Block> blocks;
  for (auto& [degree, elements] : of_degree) blocks.push_back({degree, std::move(elements)});
  return blocks;
}

BezierMap::BezierMap(const spline::Space& space) : n_points_(space.n_points), blocks_(blocks_by_degree(space)) {
  const Eigen::MatrixXd* last = nullptr;
  for (const spline::Element& element : space.elements) {
    const Eigen::MatrixXd& c = element.extraction;
    if (!last || last->rows() != c.rows() || last->cols() != c.cols() || *last != c) operators_.push_back({c, c.transpose()});
    last = &c;
    elements_.push_back({element.degree, static_cast<int>(points_.size()), static_cast<int>(operators_.size()) - 1});
    points_.insert(points_.end(), element.points.begin(), element.points.end());
  }
}

void BezierMap::points(int element, const Net& net, double* out) const {
  const Eigen::MatrixXd& rows = operators_[elements_[element].operation].by_function;
  const int* ids = points_.data() + elements_[element].first;
  const int n_b = static_cast<int>(rows.rows()), m = static_cast<int>(rows.cols());
  Room control(3 * m);
  for (int a = 0; a < m; ++a)
    for (int c = 0; c < 3; ++c) control.numbers[c * m + a] = net.data()[3 * ids[a] + c];
  three_sums(n_b, m, rows.data(), control.numbers, out);
}

void BezierMap::add_transposed(int element, const double* in, Net& net) const {
  const Eigen::MatrixXd& rows = operators_[elements_[element].operation].by_bezier;
  const int* ids = points_.data() + elements_[element].first;
  const int m = static_cast<int>(rows.rows()), n_b = static_cast<int>(rows.cols());
  Room sums(3 * m);
  three_sums(m, n_b, rows.data(), in, sums.numbers);
  for (int a = 0; a < m; ++a)
    for (int c = 0; c < 3; ++c) net(ids[a], c) += sums.numbers[c * m + a];
}

}  // namespace tanktread::surface
