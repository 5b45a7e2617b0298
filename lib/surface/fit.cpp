#include "surface/fit.hpp"

#include <deque>
#include <stdexcept>

#include "base/threads.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::surface {

LeastSquaresFit::LeastSquaresFit(const spline::Space& space) : map_(space) {
  for (const DegreeGroup& group : map_.groups()) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(group.degree + 2);
    const Eigen::MatrixXd value = spline::tensor_bernstein(group.degree, rule.s, rule.t).value;
    tables_[group.degree] = {value, value.transpose() * rule.weights.asDiagonal()};
  }
  std::deque<Eigen::MatrixXd> values;  // consecutive elements with equal extraction share one matrix
  std::vector<spline::LocalMatrix> local;
  const Eigen::MatrixXd* last = nullptr;
  for (const spline::Element& element : space.elements) {
    const Eigen::MatrixXd& c = *element.extraction;
    const Table& table = tables_.at(element.degree);
    if (!last || last->rows() != c.rows() || last->cols() != c.cols() || *last != c)
      values.push_back(c * table.weighted * table.value * c.transpose());
    last = &c;
    area_.push_back(element.size[0] * element.size[1]);
    local.push_back({element.points, &values.back(), area_.back()});
  }
  matrix_ = spline::assemble(space.n_points, local);
  if (!solver_.factor(matrix_)) throw std::logic_error("the functions of the spline space are linearly dependent");
}

Net LeastSquaresFit::fit_image(const Net& net, const std::function<Vec3(const Vec3&)>& f) const {
  Net right = Net::Zero(map_.n_points(), 3);
  for (int e = 0; e < map_.n_elements(); ++e) {
    const Table& table = tables_.at(map_.degree(e));
    Eigen::MatrixX3d bezier(map_.n_bezier(e), 3);
    map_.points(e, net, bezier.data());
    Eigen::MatrixX3d values = table.value * bezier;
    for (auto row : values.rowwise()) row = area_[e] * f(row.transpose()).transpose();
    bezier.noalias() = table.weighted * values;
    map_.add_transposed(e, bezier.data(), right);
  }
  Net fitted = net;
  each_item(3, [&](int c) { fitted.col(c) = solver_.solve(right.col(c), net.col(c)); });
  if (!((matrix_ * fitted - right).norm() <= 1e-10 * right.norm())) throw std::logic_error("a least-squares fit did not converge");
  return fitted;
}

}  // namespace tanktread::surface
