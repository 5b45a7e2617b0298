#include "surface/fit.hpp"

#include <algorithm>
#include <stdexcept>

#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::surface {
namespace {

/// Bernstein values at the nodes of a tensor rule, shape (n_q, (p+1)^2).
Eigen::MatrixXd bernstein_values(int p, const quadrature::TensorRule& rule) {
  Eigen::MatrixXd result(rule.size(), (p + 1) * (p + 1));
  double in_s[spline::max_degree + 1], in_t[spline::max_degree + 1];
  for (int q = 0; q < rule.size(); ++q) {
    spline::bernstein(p, rule.s[q], in_s);
    spline::bernstein(p, rule.t[q], in_t);
    for (int j = 0, b = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i, ++b) result(q, b) = in_s[i] * in_t[j];
  }
  return result;
}

/// Lower triangle of sum_e area_e C_e gram C_e^T, row by row: sorting a million triplets would cost more than the factorisation.
Eigen::SparseMatrix<double> mass_matrix(const spline::Space& space, const Blocks& blocks, const std::vector<Eigen::MatrixXd>& gram) {
  std::vector<std::vector<std::pair<int, double>>> columns(space.n_points);
  Eigen::MatrixXd local;
  const Eigen::MatrixXd* last = nullptr;
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const spline::Element& element = space.elements[e];
    if (!last || last->rows() != element.extraction.rows() || *last != element.extraction)
      local = element.extraction * gram[blocks.place[e].first] * element.extraction.transpose();
    last = &element.extraction;
    const double area = element.size[0] * element.size[1];
    for (std::size_t b = 0; b < element.points.size(); ++b) {
      auto& column = columns[element.points[b]];
      for (std::size_t a = 0; a < element.points.size(); ++a) {
        if (element.points[a] < element.points[b]) continue;
        const auto at = std::find_if(column.begin(), column.end(), [&](const auto& entry) { return entry.first == element.points[a]; });
        if (at == column.end())
          column.emplace_back(element.points[a], area * local(a, b));
        else
          at->second += area * local(a, b);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(space.n_points, space.n_points);
  std::size_t size = 0;
  for (const auto& column : columns) size += column.size();
  matrix.reserve(size);
  for (int b = 0; b < space.n_points; ++b) {
    std::sort(columns[b].begin(), columns[b].end());
    matrix.startVec(b);
    for (const auto& [a, value] : columns[b]) matrix.insertBack(a, b) = value;
  }
  matrix.finalize();
  return matrix;
}

}  // namespace

LeastSquaresFit::LeastSquaresFit(const spline::Space& space) : map_(space) {
  std::vector<Eigen::MatrixXd> gram;
  for (const Block& block : map_.blocks().blocks) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(block.degree + 2);
    const Eigen::MatrixXd value = bernstein_values(block.degree, rule);
    tables_.push_back({rule.s, rule.t, value, value.transpose() * rule.weights.asDiagonal()});
    gram.push_back(tables_.back().weighted * value);
  }
  for (const spline::Element& element : space.elements) area_.push_back(element.size[0] * element.size[1]);
  solver_.compute(mass_matrix(space, map_.blocks(), gram));
  if (solver_.info() != Eigen::Success) throw std::logic_error("the functions of the spline space are linearly dependent");
}

template <class Field>
Net LeastSquaresFit::solve(Field field) const {
  Net right = Net::Zero(map_.n_points(), 3);
  Eigen::MatrixXd values, projected;
  for (std::size_t k = 0; k < tables_.size(); ++k) {
    const Table& table = tables_[k];
    values.resize(table.s.size(), 3);
    for (const int e : map_.blocks().blocks[k].elements) {
      field(e, table, values);
      projected.noalias() = area_[e] * (table.weighted * values);
      map_.add_transposed(e, projected.data(), right);
    }
  }
  return solver_.solve(Eigen::MatrixXd(right));
}

Net LeastSquaresFit::fit(const std::function<Vec3(int, double, double)>& f) const {
  return solve([&](int e, const Table& table, Eigen::MatrixXd& values) {
    for (int q = 0; q < table.s.size(); ++q) values.row(q) = f(e, table.s[q], table.t[q]).transpose();
  });
}

Net LeastSquaresFit::fit_image(const Net& net, const std::function<Vec3(const Vec3&)>& f) const {
  Eigen::MatrixXd points;
  return solve([&](int e, const Table& table, Eigen::MatrixXd& values) {
    points.resize(table.value.cols(), 3);
    map_.points(e, net, points.data());
    values.noalias() = table.value * points;
    for (int q = 0; q < values.rows(); ++q) values.row(q) = f(values.row(q).transpose()).transpose();
  });
}

}  // namespace tanktread::surface
