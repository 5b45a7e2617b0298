#include "spline/transfer.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include <Eigen/LU>

#include "spline/bezier_fit.hpp"

namespace tanktread::spline {

namespace {

/// Of a field of size 1: far above rounding, far below what spaces that are not nested leave.
constexpr double nested = 1e-10;

/// A control value from one element: sum of |weights| of its Bezier points above which least squares are more accurate. 9 on a uniform mesh.
constexpr double most_amplification = 100;

using Sixteen = Eigen::Matrix<double, 16, 1>;

}  // namespace

struct Transfer::State {
  const Space& from;
  const Space& to;
  std::vector<Embedding> embedding;
  std::vector<int> copied;   // of a control point: the old one that it is, or -1
  std::vector<int> changed;  // elements on which anything may have changed
  struct Combination {       // of the old control values of an element
    int point, element;
    Eigen::VectorXd weights;
  };
  std::vector<Combination> combined;
  std::optional<BezierFit> rest;         // of few points
  mutable std::optional<BezierFit> all;  // made when it is needed

  void copy_what_is_alike();
  std::vector<int> combine_where_independent();
  double residual(const Net& field, const Net& net, const std::vector<int>& elements) const;
  std::vector<int> every(int n) const {
    std::vector<int> out(n);
    std::iota(out.begin(), out.end(), 0);
    return out;
  }
};

void Transfer::State::copy_what_is_alike() {
  copied.assign(to.n_points, -1);
  std::vector<char> alike(to.elements.size(), 0);
  for (std::size_t k = 0; k < to.elements.size(); ++k) {
    const Element &e = to.elements[k], &c = from.elements[embedding[k].around];
    alike[k] = embedding[k].whole && e.extraction.rows() == c.extraction.rows() && e.extraction == c.extraction;
    if (alike[k])
      for (std::size_t i = 0; i < e.points.size(); ++i) copied[e.points[i]] = c.points[i];
  }
  for (int k = 0; k < int(to.elements.size()); ++k) {
    const Element &e = to.elements[k], &c = from.elements[embedding[k].around];
    bool same = alike[k];
    for (std::size_t i = 0; same && i < e.points.size(); ++i) same = copied[e.points[i]] == c.points[i];
    if (!same) changed.push_back(k);
  }
}

/// Points that one element determines, on the one where their function is largest; returns those that none does.
std::vector<int> Transfer::State::combine_where_independent() {
  struct Best {
    double mean = 0;
    int element = -1;
  };
  std::vector<Best> best(to.n_points);
  for (int k : changed) {
    const Element& e = to.elements[k];
    const bool independent = e.degree == 3 && e.points.size() == 16 && from.elements[embedding[k].around].degree == 3;
    if (!independent) continue;
    for (int i = 0; i < 16; ++i) {
      Best& b = best[e.points[i]];
      const double mean = copied[e.points[i]] < 0 ? e.extraction.row(i).sum() : 0;
      if (mean > b.mean) b = {mean, k};
    }
  }
  std::vector<int> left;
  std::vector<char> seen(to.n_points, 0);
  for (int k : changed) {
    const Element& e = to.elements[k];
    std::vector<int> here;
    for (int i = 0; i < int(e.points.size()); ++i) {
      const int p = e.points[i];
      if (copied[p] < 0 && best[p].element == k) here.push_back(i);
      if (copied[p] < 0 && best[p].element < 0 && !seen[p]) seen[p] = 1, left.push_back(p);
    }
    if (here.empty()) continue;
    const Element& c = from.elements[embedding[k].around];
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(e.extraction);
    for (int i : here) {
      Sixteen w = lu.solve(Sixteen(Sixteen::Unit(i)));
      if (!(w.cwiseAbs().sum() <= most_amplification)) {
        left.push_back(e.points[i]);
        continue;
      }
      if (!embedding[k].whole) {
        const Eigen::Matrix4d S = embedding[k].s, T = embedding[k].t;
        Eigen::Map<Eigen::Matrix4d> W(w.data());
        W = (S.transpose() * W * T).eval();
      }
      combined.push_back({e.points[i], embedding[k].around, c.extraction.lazyProduct(w)});
    }
  }
  std::sort(left.begin(), left.end());
  return left;
}

double Transfer::State::residual(const Net& field, const Net& net, const std::vector<int>& elements) const {
  double largest = 0;
  for (int k : elements)
    largest =
        std::max(largest, (own_points(to.elements[k], embedding[k], net) - restricted(from, embedding[k], field)).cwiseAbs().maxCoeff());
  return largest;
}

Transfer::Transfer(const Space& from, const Space& to) : state_(new State{from, to, embeddings(from, to), {}, {}, {}, {}, {}}) {
  state_->copy_what_is_alike();
  const auto left = state_->combine_where_independent();
  if (!left.empty()) state_->rest.emplace(from, to, state_->embedding, left);
}

Transfer::~Transfer() = default;
Transfer::Transfer(Transfer&&) noexcept = default;

int Transfer::straddling() const {
  return int(std::count_if(state_->embedding.begin(), state_->embedding.end(), [](const Embedding& e) { return e.straddles; }));
}

Transfer::Result Transfer::operator()(const Net& field) const {
  const State& s = *state_;
  Result out{Net::Zero(s.to.n_points, 3), 0};
  for (int p = 0; p < s.to.n_points; ++p)
    if (s.copied[p] >= 0) out.net.row(p) = field.row(s.copied[p]);
  for (const auto& c : s.combined) {
    const auto& points = s.from.elements[c.element].points;
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (std::size_t a = 0; a < points.size(); ++a) sum += c.weights[Eigen::Index(a)] * field.row(points[a]);
    out.net.row(c.point) = sum;
  }
  if (s.rest) s.rest->solve(field, out.net);
  out.residual = s.residual(field, out.net, s.changed);
  if (out.residual <= nested * field.cwiseAbs().maxCoeff()) return out;
  if (!s.all) s.all.emplace(s.from, s.to, s.embedding, s.every(s.to.n_points));
  s.all->solve(field, out.net);
  out.residual = s.residual(field, out.net, s.every(int(s.to.elements.size())));
  return out;
}

}  // namespace tanktread::spline
