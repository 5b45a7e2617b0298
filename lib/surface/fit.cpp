#include "surface/fit.hpp"

#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>

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

/// Three columns and one of zeros, so that a row is one register.
using Wide = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;
using Row = Eigen::Array<double, 1, 4>;

Row ratio(const Row& a, const Row& b) { return (b > 0).select(a / b, 0); }

}  // namespace

LeastSquaresFit::LeastSquaresFit(const spline::Space& space) : map_(space) {
  std::vector<Eigen::MatrixXd> gram;
  for (const Block& block : map_.blocks().blocks) {
    const quadrature::TensorRule& rule = quadrature::tensor_gauss(block.degree + 2);
    const Eigen::MatrixXd value = bernstein_values(block.degree, rule);
    tables_.push_back({value, value.transpose() * rule.weights.asDiagonal()});
    gram.push_back(tables_.back().weighted * value);
  }
  for (const spline::Element& element : space.elements) area_.push_back(element.size[0] * element.size[1]);
  mass_ = mass(space, map_.blocks(), gram);
  inverse_ = approximate_inverse(mass_);
}

void LeastSquaresFit::Rows::close(int diagonal, double entry) {
  column.push_back(diagonal);
  value.push_back(entry);
  start.push_back(static_cast<int>(value.size()));
}

/// sum_e area_e C_e gram C_e^T, lower triangle, row by row: the elements around a function, then a dense accumulator.
LeastSquaresFit::Rows LeastSquaresFit::mass(const spline::Space& space, const Blocks& blocks, const std::vector<Eigen::MatrixXd>& gram) {
  struct Place {
    std::size_t element, local;
    Eigen::Index row;
  };
  std::vector<std::vector<Place>> around(static_cast<std::size_t>(space.n_points));
  std::vector<Eigen::MatrixXd> locals;  // neighbours share one
  const Eigen::MatrixXd* last = nullptr;
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const spline::Element& element = space.elements[e];
    if (!last || last->rows() != element.extraction.rows() || *last != element.extraction)
      locals.push_back(element.extraction * gram[blocks.place[e].first] * element.extraction.transpose());
    last = &element.extraction;
    for (std::size_t a = 0; a < element.points.size(); ++a)
      around[element.points[a]].push_back({e, locals.size() - 1, static_cast<Eigen::Index>(a)});
  }
  Rows m;
  std::vector<int> entry(around.size(), -1);
  for (int a = 0; a < space.n_points; ++a) {
    double diagonal = 0;
    for (const Place& place : around[a]) {
      const std::vector<int>& points = space.elements[place.element].points;
      const double area = space.elements[place.element].size[0] * space.elements[place.element].size[1];
      const double* values = locals[place.local].col(place.row).data();
      diagonal += area * values[place.row];
      for (std::size_t b = 0; b < points.size(); ++b) {
        if (points[b] >= a) continue;
        int& at = entry[points[b]];
        if (at < m.start.back()) {
          at = static_cast<int>(m.value.size());
          m.column.push_back(points[b]);
          m.value.push_back(0);
        }
        m.value[at] += area * values[b];
      }
    }
    m.close(a, diagonal);
  }
  return m;
}

/// Row i of G on its strongest couplings J: y/sqrt(y_i), M_JJ y = e_i.
LeastSquaresFit::Rows LeastSquaresFit::approximate_inverse(const Rows& mass) {
  constexpr double strong = 0.03;
  constexpr int most = 16;
  const int n = static_cast<int>(mass.start.size()) - 1;
  const auto diagonal = [&](int i) { return mass.value[mass.start[i + 1] - 1]; };
  Rows g;
  std::vector<int> place(static_cast<std::size_t>(n), -1), chosen;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most> local;
  for (int i = 0; i < n; ++i) {
    chosen.clear();
    for (int k = mass.start[i]; k + 1 < mass.start[i + 1] && static_cast<int>(chosen.size()) + 1 < most; ++k)
      if (std::abs(mass.value[k]) > strong * std::sqrt(diagonal(i) * diagonal(mass.column[k]))) chosen.push_back(mass.column[k]);
    chosen.push_back(i);
    const int size = static_cast<int>(chosen.size());
    for (int p = 0; p < size; ++p) place[chosen[p]] = p;
    local.setZero(size, size);
    for (int p = 0; p < size; ++p)
      for (int k = mass.start[chosen[p]]; k < mass.start[chosen[p] + 1]; ++k)
        if (const int q = place[mass.column[k]]; q >= 0) local(p, q) = local(q, p) = mass.value[k];
    for (const int j : chosen) place[j] = -1;
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1> y = local.llt().solve(Eigen::VectorXd::Unit(size, size - 1));
    const double factor = 1 / std::sqrt(y[size - 1]);
    for (int p = 0; p + 1 < size; ++p) {
      g.column.push_back(chosen[p]);
      g.value.push_back(factor * y[p]);
    }
    g.close(i, factor * y[size - 1]);
  }
  return g;
}

Net LeastSquaresFit::solve(const Net& right, const Net& start) const {
  const Eigen::Index n = right.rows();
  const auto times_mass = [&](const Wide& in, Wide& out) {
    out.setZero();
    for (Eigen::Index i = 0; i < n; ++i) {
      const int last = mass_.start[i + 1] - 1;
      const Row own = in.row(i);
      Row sum = mass_.value[last] * own;
      for (int k = mass_.start[i]; k < last; ++k) {
        const int j = mass_.column[k];
        sum += mass_.value[k] * in.row(j).array();
        out.row(j).array() += mass_.value[k] * own;
      }
      out.row(i).array() += sum;
    }
  };
  const auto times_inverse = [&](const Wide& in, Wide& out) {
    out.setZero();
    for (Eigen::Index i = 0; i < n; ++i) {
      Row sum = Row::Zero();
      for (int k = inverse_.start[i]; k < inverse_.start[i + 1]; ++k) sum += inverse_.value[k] * in.row(inverse_.column[k]).array();
      for (int k = inverse_.start[i]; k < inverse_.start[i + 1]; ++k) out.row(inverse_.column[k]).array() += inverse_.value[k] * sum;
    }
  };
  const auto dot = [](const Wide& a, const Wide& b) { return Row((a.array() * b.array()).colwise().sum()); };

  Wide x = Wide::Zero(n, 4), r = x, p = x, z(n, 4);
  x.leftCols<3>() = start;
  r.leftCols<3>() = right;
  const double goal = 1e-15 * r.colwise().norm().maxCoeff();
  times_mass(x, z);
  r -= z;
  Row before = Row::Zero();  // r . G^T G r of the iteration before
  for (Eigen::Index k = 0; !(r.colwise().norm().maxCoeff() <= goal); ++k) {
    if (k > n + 100) throw std::logic_error("the functions of the spline space are linearly dependent");
    times_inverse(r, z);
    const Row rz = dot(r, z);
    p = z.array() + p.array().rowwise() * ratio(rz, before);
    times_mass(p, z);
    const Row step = ratio(rz, dot(p, z));
    x.array() += p.array().rowwise() * step;
    r.array() -= z.array().rowwise() * step;
    before = rz;
  }
  return x.leftCols<3>();
}

Net LeastSquaresFit::fit_image(const Net& net, const std::function<Vec3(const Vec3&)>& f) const {
  Net right = Net::Zero(map_.n_points(), 3);
  Eigen::MatrixXd bezier, values;
  for (std::size_t k = 0; k < tables_.size(); ++k) {
    const Block& block = map_.blocks().blocks[k];
    const auto n = static_cast<Eigen::Index>(block.elements.size()), n_b = tables_[k].value.cols();
    map_.points(block, net, bezier);
    values.noalias() = tables_[k].value * bezier;
    for (Eigen::Index e = 0; e < n; ++e)
      for (Eigen::Index q = 0; q < values.rows(); ++q) {
        const Vec3 image = area_[block.elements[e]] * f(Vec3(values(q, e), values(q, n + e), values(q, 2 * n + e)));
        for (int c = 0; c < 3; ++c) values(q, c * n + e) = image[c];
      }
    bezier.noalias() = tables_[k].weighted * values;
    Eigen::MatrixXd one(n_b, 3);
    for (Eigen::Index e = 0; e < n; ++e) {
      for (int c = 0; c < 3; ++c) one.col(c) = bezier.col(c * n + e);
      map_.add_transposed(block.elements[e], one.data(), right);
    }
  }
  return solve(right, net);
}

}  // namespace tanktread::surface
