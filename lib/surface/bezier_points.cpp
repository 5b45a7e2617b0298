#include "surface/bezier_points.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <unordered_map>

namespace tanktread::surface {
namespace {

std::string bytes(const Eigen::MatrixXd& matrix) {
  std::string key = std::to_string(matrix.rows()) + ':';
  key.append(reinterpret_cast<const char*>(matrix.data()), sizeof(double) * static_cast<std::size_t>(matrix.size()));
  return key;
}

using Eight [[gnu::vector_size(8 * sizeof(double)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;  // at any address

/// Three sums of rows of n numbers, out[c n + k] = sum_r factor(r, c) rows[r n + k].
template <int n, class Factor>
void three_sums(int n_rows, const double* rows, const Factor& factor, double* out) {
  constexpr int wide = n / 8, rest = n % 8;
  Eight sum[3][wide] = {};
  double tail[3][rest + 1] = {};
  for (int r = 0; r < n_rows; ++r, rows += n)
    for (int c = 0; c < 3; ++c) {
      const double f = factor(r, c);
      for (int k = 0; k < wide; ++k) sum[c][k] += f * reinterpret_cast<const Eight*>(rows)[k];
      for (int k = 0; k < rest; ++k) tail[c][k] += f * rows[8 * wide + k];
    }
  for (int c = 0; c < 3; ++c, out += n) {
    for (int k = 0; k < wide; ++k) reinterpret_cast<Eight*>(out)[k] = sum[c][k];
    std::copy_n(tail[c], rest, out + 8 * wide);
  }
}

template <class Factor>
void three_sums(int n, int n_rows, const double* rows, const Factor& factor, double* out) {
  if (n == 16) return three_sums<16>(n_rows, rows, factor, out);  // a bicubic element
  if (n == 25) return three_sums<25>(n_rows, rows, factor, out);
  std::fill_n(out, 3 * n, 0.);
  for (int r = 0; r < n_rows; ++r)
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < n; ++k) out[c * n + k] += factor(r, c) * rows[r * n + k];
}

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

Eigen::MatrixXd bezier_points(const spline::Space& space, const Block& block, const Net& net) {
  const int n_e = static_cast<int>(block.elements.size());
  const int n_b = (block.degree + 1) * (block.degree + 1);
  Eigen::MatrixXd result(n_b, 3 * n_e);
  for (int k = 0; k < n_e; ++k) {
    const spline::Element& element = space.elements[block.elements[k]];
    for (int b = 0; b < n_b; ++b) {
      Vec3 sum = Vec3::Zero();
      for (int a = 0; a < static_cast<int>(element.points.size()); ++a)
        sum += element.extraction(a, b) * net.row(element.points[a]).transpose();
      for (int c = 0; c < 3; ++c) result(b, c * n_e + k) = sum[c];
    }
  }
  return result;
}

BezierMap::BezierMap(const spline::Space& space) : n_points_(space.n_points), blocks_(blocks_by_degree(space)) {
  std::unordered_map<std::string, int> known;
  for (const spline::Element& element : space.elements) {
    const Eigen::MatrixXd& c = element.extraction;
    const auto [found, fresh] = known.try_emplace(bytes(c), static_cast<int>(operators_.size()));
    if (fresh) {
      Operator operation{static_cast<int>(c.rows()), static_cast<int>(c.cols()), {}, {}};
      operation.by_bezier.assign(c.data(), c.data() + c.size());
      for (int a = 0; a < operation.m; ++a)
        for (int b = 0; b < operation.n_b; ++b) operation.by_function.push_back(c(a, b));
      operators_.push_back(std::move(operation));
    }
    elements_.push_back({element.degree, static_cast<int>(points_.size()), found->second});
    points_.insert(points_.end(), element.points.begin(), element.points.end());
  }
}

void BezierMap::points(int element, const Net& net, double* out) const {
  const Operator& c = operators_[elements_[element].operation];
  const int* ids = points_.data() + elements_[element].first;
  three_sums(c.n_b, c.m, c.by_function.data(), [&](int a, int k) { return net.data()[3 * ids[a] + k]; }, out);
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
  constexpr int most = 64;
  double values[3 * most];
  std::vector<double> larger;
  double* out = values;
  if (operation.m > most) {
    larger.resize(3 * operation.m);
    out = larger.data();
  }
  three_sums(operation.m, operation.n_b, operation.by_bezier.data(), [&](int b, int c) { return in[c * operation.n_b + b]; }, out);
  for (int a = 0; a < operation.m; ++a)
    for (int c = 0; c < 3; ++c) net(ids[a], c) += out[c * operation.m + a];
}

void BezierMap::add_transposed(int element, const double* in, Eigen::VectorXd& field) const {
  const Operator& operation = operators_[elements_[element].operation];
  const int* ids = points_.data() + elements_[element].first;
  std::vector<double> values(operation.m);
  for (int b = 0; b < operation.n_b; ++b)
    for (int a = 0; a < operation.m; ++a) values[a] += operation.by_bezier[b * operation.m + a] * in[b];
  for (int a = 0; a < operation.m; ++a) field[ids[a]] += values[a];
}

}  // namespace tanktread::surface
