#include "surface/fit.hpp"

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
}

/// sum_e area_e C_e gram C_e^T, row by row: the elements around a function, then a dense accumulator.
LeastSquaresFit::Mass LeastSquaresFit::mass(const spline::Space& space, const Blocks& blocks, const std::vector<Eigen::MatrixXd>& gram) {
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
  Mass m;
  std::vector<int> entry(around.size(), -1);
  for (std::size_t a = 0; a < around.size(); ++a) {
    for (const Place& place : around[a]) {
      const spline::Element& element = space.elements[place.element];
      const double area = element.size[0] * element.size[1];
      const double* values = locals[place.local].col(place.row).data();
      for (std::size_t b = 0; b < element.points.size(); ++b) {
        int& at = entry[element.points[b]];
        if (at < m.start.back()) {
          at = static_cast<int>(m.value.size());
          m.column.push_back(element.points[b]);
          m.value.push_back(0);
        }
        m.value[at] += area * values[b];
      }
    }
    m.diagonal.push_back(m.value[entry[a]]);
    m.start.push_back(static_cast<int>(m.value.size()));
  }
  return m;
}

Net LeastSquaresFit::solve(const Net& right, const Net& start) const {
  const Eigen::Index n = right.rows();
  const auto product = [&](const Wide& x, Eigen::Index i) {
    Row even = Row::Zero(), odd = Row::Zero();
    int k = mass_.start[i];
    for (; k + 1 < mass_.start[i + 1]; k += 2) {
      even += mass_.value[k] * x.row(mass_.column[k]).array();
      odd += mass_.value[k + 1] * x.row(mass_.column[k + 1]).array();
    }
    if (k < mass_.start[i + 1]) even += mass_.value[k] * x.row(mass_.column[k]).array();
    return Row(even + odd);
  };
  Wide x = Wide::Zero(n, 4), r = x, p = x, mp = x;
  x.leftCols<3>() = start;
  r.leftCols<3>() = right;
  const double goal = 1e-15 * r.colwise().norm().maxCoeff();
  for (Eigen::Index i = 0; i < n; ++i) r.row(i).array() -= product(x, i);
  Row before = Row::Zero();  // r . D^-1 r of the iteration before
  for (Eigen::Index k = 0; r.colwise().norm().maxCoeff() > goal; ++k) {
    if (k > n + 100) throw std::logic_error("the functions of the spline space are linearly dependent");
    Row rr = Row::Zero(), pmp = rr;
    for (Eigen::Index i = 0; i < n; ++i) rr += r.row(i).array().square() / mass_.diagonal[i];
    const Row turn = ratio(rr, before);
    for (Eigen::Index i = 0; i < n; ++i) p.row(i) = r.row(i).array() / mass_.diagonal[i] + turn * p.row(i).array();
    for (Eigen::Index i = 0; i < n; ++i) {
      mp.row(i) = product(p, i);
      pmp += p.row(i).array() * mp.row(i).array();
    }
    const Row step = ratio(rr, pmp);
    x.array() += p.array().rowwise() * step;
    r.array() -= mp.array().rowwise() * step;
    before = rr;
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
