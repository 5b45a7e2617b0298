#include "spline/transfer.hpp"

#include <algorithm>

#include <Eigen/SparseCholesky>

#include "spline/bernstein.hpp"
#include "spline/locate.hpp"
#include "spline/normal_matrix.hpp"

namespace tanktread::spline {

struct Transfer::State {
  const Space& from;
  const Space& to;
  struct Part {            // of one element of `to`
    int coarse;            // the element of `from` around it
    bool whole;            // which it is, placed and graded alike
    Eigen::MatrixXd s, t;  // restriction (and elevation) of the coarse Bezier points along s and t
    Eigen::MatrixXd fine;  // elevation of the fine ones where the coarse degree is higher; empty otherwise
  };
  std::vector<Part> parts;
  int straddling = 0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
};

namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;  // Bezier points, row n j + i

/// Bezier points of a field on an element, C^T P.
Points bezier_points(const Element& e, const Net& field) {
  Points P(Eigen::Index(e.points.size()), 3);
  for (std::size_t i = 0; i < e.points.size(); ++i) P.row(Eigen::Index(i)) = field.row(e.points[i]);
  return e.extraction.transpose() * P;
}

/// (T x S) applied to Bezier points.
Points along_both(const Eigen::MatrixXd& S, const Eigen::MatrixXd& T, const Points& Q) {
  Points out(S.rows() * T.rows(), 3);
  for (int d = 0; d < 3; ++d) {
    const Eigen::Map<const Eigen::MatrixXd> in(Q.col(d).data(), S.cols(), T.cols());
    Eigen::Map<Eigen::MatrixXd>(out.col(d).data(), S.rows(), T.rows()) = S * in * T.transpose();
  }
  return out;
}

Eigen::MatrixXd tensor(const Eigen::MatrixXd& S) {
  const Eigen::Index m = S.rows(), n = S.cols();
  Eigen::MatrixXd out(m * m, n * n);
  for (Eigen::Index j = 0; j < m; ++j)
    for (Eigen::Index l = 0; l < n; ++l) out.block(j * m, l * n, m, n) = S(j, l) * S;
  return out;
}

}  // namespace

Transfer::Transfer(const Space& from, const Space& to) : state_(new State{from, to, {}, 0, {}}) {
  const Locator locate(from);
  std::vector<Eigen::MatrixXd> normal(to.elements.size());
  state_->parts.reserve(to.elements.size());
  for (std::size_t k = 0; k < to.elements.size(); ++k) {
    const Element& e = to.elements[k];
    State::Part part;
    part.coarse = locate({e.face, e.origin[0] + e.size[0] / 2, e.origin[1] + e.size[1] / 2}).element;
    const Element& c = from.elements[part.coarse];
    part.whole = e.degree == c.degree && e.origin == c.origin && e.size == c.size;
    if (!part.whole) {
      double low[2], high[2];
      for (int d = 0; d < 2; ++d) {
        low[d] = (e.origin[d] - c.origin[d]) / c.size[d];
        high[d] = (e.origin[d] + e.size[d] - c.origin[d]) / c.size[d];
      }
      const double margin = 1e-9;
      if (std::min(low[0], low[1]) < -margin || std::max(high[0], high[1]) > 1 + margin) ++state_->straddling;
      part.s = restriction(c.degree, low[0], high[0]);
      part.t = restriction(c.degree, low[1], high[1]);
      if (e.degree > c.degree) {
        const Eigen::MatrixXd up = elevation(c.degree, e.degree);
        part.s = up * part.s;
        part.t = up * part.t;
      } else if (e.degree < c.degree) {
        part.fine = tensor(elevation(e.degree, c.degree));
      }
    }
    if (part.fine.size() == 0) {
      normal[k].noalias() = e.extraction * e.extraction.transpose();
    } else {
      const Eigen::MatrixXd rows = part.fine * e.extraction.transpose();
      normal[k].noalias() = rows.transpose() * rows;
    }
    state_->parts.push_back(std::move(part));
  }
  state_->factor.compute(assemble(to, normal));
}

Transfer::~Transfer() = default;
Transfer::Transfer(Transfer&&) noexcept = default;

int Transfer::straddling() const { return state_->straddling; }

Transfer::Result Transfer::operator()(const Net& field) const {
  const Space &from = state_->from, &to = state_->to;
  std::vector<Points> target(to.elements.size());
  Net right = Net::Zero(to.n_points, 3);
  for (std::size_t k = 0; k < to.elements.size(); ++k) {
    const auto& part = state_->parts[k];
    const Element& e = to.elements[k];
    target[k] = bezier_points(from.elements[part.coarse], field);
    if (!part.whole) target[k] = along_both(part.s, part.t, target[k]);
    const Points r = part.fine.size() == 0 ? Points(e.extraction * target[k]) : Points(e.extraction * (part.fine.transpose() * target[k]));
    for (std::size_t i = 0; i < e.points.size(); ++i) right.row(e.points[i]) += r.row(Eigen::Index(i));
  }
  Result out{Net(to.n_points, 3), 0};
  for (int d = 0; d < 3; ++d) out.net.col(d) = state_->factor.solve(Eigen::VectorXd(right.col(d)));
  for (std::size_t k = 0; k < to.elements.size(); ++k) {
    const auto& part = state_->parts[k];
    Points now = bezier_points(to.elements[k], out.net);
    if (part.fine.size() > 0) now = Points(part.fine * now);
    out.residual = std::max(out.residual, (now - target[k]).cwiseAbs().maxCoeff());
  }
  return out;
}

}  // namespace tanktread::spline
