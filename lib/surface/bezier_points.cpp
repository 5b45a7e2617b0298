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

template <int n_b>
void bezier_points(int m, const double* extraction, const int* ids, const Net& net, double* out) {
  double sum[3][n_b] = {};
  for (int a = 0; a < m; ++a) {
    const double* row = extraction + a * n_b;
    const double* p = net.data() + 3 * ids[a];
    for (int b = 0; b < n_b; ++b) {
      sum[0][b] += row[b] * p[0];
      sum[1][b] += row[b] * p[1];
      sum[2][b] += row[b] * p[2];
    }
  }
  std::copy_n(&sum[0][0], 3 * n_b, out);
}

void bezier_points(int m, int n_b, const double* extraction, const int* ids, const Net& net, double* out) {
  std::fill_n(out, 3 * n_b, 0.);
  for (int a = 0; a < m; ++a)
    for (int c = 0; c < 3; ++c)
      for (int b = 0; b < n_b; ++b) out[c * n_b + b] += extraction[a * n_b + b] * net(ids[a], c);
}

template <int m>
void function_values(int n_b, const double* extraction, const double* in, double* out) {
  double sum[m] = {};
  for (int b = 0; b < n_b; ++b)
    for (int a = 0; a < m; ++a) sum[a] += extraction[b * m + a] * in[b];
  std::copy_n(sum, m, out);
}

/// out_A = sum_b extraction(A, b) in_b
void function_values(int m, int n_b, const double* extraction, const double* in, double* out) {
  if (m == 16) return function_values<16>(n_b, extraction, in, out);
  std::fill_n(out, m, 0.);
  for (int b = 0; b < n_b; ++b)
    for (int a = 0; a < m; ++a) out[a] += extraction[b * m + a] * in[b];
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
  if (c.n_b == 16) return bezier_points<16>(c.m, c.by_function.data(), ids, net, out);
  if (c.n_b == 25) return bezier_points<25>(c.m, c.by_function.data(), ids, net, out);
  bezier_points(c.m, c.n_b, c.by_function.data(), ids, net, out);
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
  double values[3][most];
  std::vector<double> larger;
  double* out[3] = {values[0], values[1], values[2]};
  if (operation.m > most) {
    larger.resize(3 * operation.m);
    for (int c = 0; c < 3; ++c) out[c] = larger.data() + c * operation.m;
  }
  for (int c = 0; c < 3; ++c) function_values(operation.m, operation.n_b, operation.by_bezier.data(), in + c * operation.n_b, out[c]);
  for (int a = 0; a < operation.m; ++a)
    for (int c = 0; c < 3; ++c) net(ids[a], c) += out[c][a];
}

void BezierMap::add_transposed(int element, const double* in, Eigen::VectorXd& field) const {
  const Operator& operation = operators_[elements_[element].operation];
  const int* ids = points_.data() + elements_[element].first;
  std::vector<double> values(operation.m);
  function_values(operation.m, operation.n_b, operation.by_bezier.data(), in, values.data());
  for (int a = 0; a < operation.m; ++a) field[ids[a]] += values[a];
}

}  // namespace tanktread::surface
