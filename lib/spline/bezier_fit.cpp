#include "spline/bezier_fit.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/SparseCholesky>

#include "spline/locate.hpp"
#include "spline/normal_matrix.hpp"

namespace tanktread::spline {

namespace {

/// (T x S) applied to Bezier points.
BezierPoints along_both(const Eigen::MatrixXd& S, const Eigen::MatrixXd& T, const BezierPoints& Q) {
  BezierPoints out(S.rows() * T.rows(), 3);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_degree + 1, max_degree + 1> half(S.rows(), T.cols());
  for (int d = 0; d < 3; ++d) {
    const Eigen::Map<const Eigen::MatrixXd> in(Q.col(d).data(), S.cols(), T.cols());
    half = S.lazyProduct(in);
    Eigen::Map<Eigen::MatrixXd>(out.col(d).data(), S.rows(), T.rows()) = half.lazyProduct(T.transpose());
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

Embedding embedding_in(const Space& from, int around, const Element& e) {
  Embedding out;
  out.around = around;
  const Element& c = from.elements[around];
  out.whole = e.degree == c.degree && e.origin == c.origin && e.size == c.size;
  if (out.whole) return out;
  double low[2], high[2];
  for (int d = 0; d < 2; ++d) {
    low[d] = (e.origin[d] - c.origin[d]) / c.size[d];
    high[d] = (e.origin[d] + e.size[d] - c.origin[d]) / c.size[d];
  }
  const double margin = 1e-9;
  out.straddles = std::min(low[0], low[1]) < -margin || std::max(high[0], high[1]) > 1 + margin;
  out.s = restriction(c.degree, low[0], high[0]);
  out.t = restriction(c.degree, low[1], high[1]);
  if (e.degree > c.degree) {
    const Eigen::MatrixXd up = elevation(c.degree, e.degree);
    out.s = up * out.s;
    out.t = up * out.t;
  } else if (e.degree < c.degree) {
    out.raised = tensor(elevation(e.degree, c.degree));
  }
  return out;
}

}  // namespace

BezierPoints bezier_points(const Element& e, const Net& field) {
  const auto gather = [&](auto& P) {
    for (std::size_t i = 0; i < e.points.size(); ++i) P.row(Eigen::Index(i)) = field.row(e.points[i]);
  };
  if (e.degree == 3 && e.points.size() == 16) {  // of a size that the compiler knows
    Eigen::Matrix<double, 16, 3> P;
    gather(P);
    return Eigen::Map<const Eigen::Matrix<double, 16, 16>>(e.extraction.data()).transpose().lazyProduct(P);
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> P(Eigen::Index(e.points.size()), 3);
  gather(P);
  return e.extraction.transpose().lazyProduct(P);
}

std::vector<Embedding> embeddings(const Space& from, const Space& to) {
  const Locator locate(from);
  std::vector<Embedding> out;
  out.reserve(to.elements.size());
  for (const Element& e : to.elements)
    out.push_back(embedding_in(from, locate({e.face, e.origin[0] + e.size[0] / 2, e.origin[1] + e.size[1] / 2}).element, e));
  return out;
}

BezierPoints restricted(const Space& from, const Embedding& embedding, const Net& field) {
  BezierPoints out = bezier_points(from.elements[embedding.around], field);
  return embedding.whole ? out : along_both(embedding.s, embedding.t, out);
}

BezierPoints own_points(const Element& e, const Embedding& embedding, const Net& field) {
  BezierPoints out = bezier_points(e, field);
  return embedding.raised.size() == 0 ? out : BezierPoints(embedding.raised * out);
}

struct BezierFit::State {
  const Space& from;
  const Space& to;
  const std::vector<Embedding>& embedding;
  const std::vector<int> unknown;
  struct Rows {  // of one element's unknown points in its Bezier points
    int element;
    std::vector<int> number;  // in the system
    Eigen::MatrixXd values;
  };
  std::vector<Rows> rows;
  bool all = false;  // points are unknown
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
};

BezierFit::BezierFit(const Space& from, const Space& to, const std::vector<Embedding>& embedding, const std::vector<int>& unknown)
    : state_(new State{from, to, embedding, unknown, {}, int(unknown.size()) == to.n_points, {}}) {
  std::vector<int> number(to.n_points, -1);
  for (std::size_t i = 0; i < unknown.size(); ++i) number[unknown[i]] = int(i);
  std::vector<LocalMatrix> normal;
  for (int k = 0; k < int(to.elements.size()); ++k) {
    const Element& e = to.elements[k];
    State::Rows rows{k, {}, {}};
    std::vector<Eigen::Index> own;
    for (std::size_t i = 0; i < e.points.size(); ++i)
      if (number[e.points[i]] >= 0) own.push_back(Eigen::Index(i)), rows.number.push_back(number[e.points[i]]);
    if (own.empty()) continue;
    rows.values = e.extraction(own, Eigen::all);
    if (embedding[k].raised.size() > 0) rows.values *= embedding[k].raised.transpose();
    normal.push_back({rows.number, rows.values * rows.values.transpose()});
    state_->rows.push_back(std::move(rows));
  }
  state_->factor.compute(assemble(int(unknown.size()), normal));
}

BezierFit::~BezierFit() = default;

void BezierFit::solve(const Net& field, Net& net) const {
  const auto& s = *state_;
  for (int p : s.unknown) net.row(p).setZero();
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(Eigen::Index(s.unknown.size()), 3);
  for (const auto& rows : s.rows) {
    const Embedding& in = s.embedding[rows.element];
    BezierPoints rest = restricted(s.from, in, field);
    if (!s.all) rest -= own_points(s.to.elements[rows.element], in, net);
    const Eigen::MatrixXd r = rows.values.lazyProduct(rest);
    for (std::size_t i = 0; i < rows.number.size(); ++i) right.row(rows.number[i]) += r.row(Eigen::Index(i));
  }
  const Eigen::MatrixXd values = s.factor.solve(right);
  for (std::size_t i = 0; i < s.unknown.size(); ++i) net.row(s.unknown[i]) = values.row(Eigen::Index(i));
}

}  // namespace tanktread::spline
