#include "surface/bezier_points.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <unordered_map>

#include "surface/three_sums.hpp"

namespace tanktread::surface {
namespace {

std::string bytes(const Eigen::MatrixXd& matrix) {
  std::string key = std::to_string(matrix.rows()) + ':';
  key.append(reinterpret_cast<const char*>(matrix.data()), sizeof(double) * static_cast<std::size_t>(matrix.size()));
  return key;
}

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

Blocks blocks_by_degree(const spline::Space& space) {
  std::map<int, std::vector<int>> of_degree;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) of_degree[space.elements[e].degree].push_back(e);
  Blocks result;
  result.place.resize(space.elements.size());
  for (auto& [degree, elements] : of_degree) {
    const int block = static_cast<int>(result.blocks.size());
    for (int k = 0; k < static_cast<int>(elements.size()); ++k) result.place[elements[k]] = {block, k};
    result.blocks.push_back({degree, std::move(elements)});
  }
  return result;
}

BezierMap::BezierMap(const spline::Space& space) : n_points_(space.n_points), blocks_(blocks_by_degree(space)) {
  std::unordered_map<std::string, int> known;
  const Eigen::MatrixXd* last = nullptr;  // of the element before, which mostly has the same
  int operation = 0;
  for (const spline::Element& element : space.elements) {
    const Eigen::MatrixXd& c = element.extraction;
    if (!last || last->rows() != c.rows() || last->cols() != c.cols() || *last != c) {
      const auto [found, fresh] = known.try_emplace(bytes(c), static_cast<int>(operators_.size()));
      operation = found->second;
      if (fresh) {
        Operator map{static_cast<int>(c.rows()), static_cast<int>(c.cols()), {}, {}};
        map.by_bezier.assign(c.data(), c.data() + c.size());
        for (int a = 0; a < map.m; ++a)
          for (int b = 0; b < map.n_b; ++b) map.by_function.push_back(c(a, b));
        operators_.push_back(std::move(map));
      }
    }
    last = &c;
    elements_.push_back({element.degree, static_cast<int>(points_.size()), operation});
    points_.insert(points_.end(), element.points.begin(), element.points.end());
  }
}

void BezierMap::points(int element, const Net& net, double* out) const {
  const Operator& c = operators_[elements_[element].operation];
  const int* ids = points_.data() + elements_[element].first;
  Room control(3 * c.m);
  for (int a = 0; a < c.m; ++a)
    for (int k = 0; k < 3; ++k) control.numbers[k * c.m + a] = net.data()[3 * ids[a] + k];
  three_sums(c.n_b, c.m, c.by_function.data(), control.numbers, out);
}

void BezierMap::points(const Block& block, const Net& net, Eigen::MatrixXd& out) const {
  const int n_e = static_cast<int>(block.elements.size());
  const int n_b = (block.degree + 1) * (block.degree + 1);
  out.resize(n_b, 3 * n_e);
  std::vector<double> one(3 * n_b);
  for (int k = 0; k < n_e; ++k) {
    points(block.elements[k], net, one.data());
    for (int c = 0; c < 3; ++c) std::copy_n(one.data() + c * n_b, n_b, out.col(c * n_e + k).data());
  }
}

void BezierMap::add_transposed(int element, const double* in, Net& net) const {
  const Operator& operation = operators_[elements_[element].operation];
  const int* ids = points_.data() + elements_[element].first;
  Room sums(3 * operation.m);
  three_sums(operation.m, operation.n_b, operation.by_bezier.data(), in, sums.numbers);
  for (int a = 0; a < operation.m; ++a)
    for (int c = 0; c < 3; ++c) net(ids[a], c) += sums.numbers[c * operation.m + a];
}

}  // namespace tanktread::surface
