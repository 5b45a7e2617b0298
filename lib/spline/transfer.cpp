#include "spline/transfer.hpp"

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <memory>
#include <optional>

#include <Eigen/SparseCholesky>

#include "base/indices.hpp"
#include "spline/basis.hpp"
#include "spline/locate.hpp"
#include "spline/sparse_systems.hpp"

namespace tanktread::spline {

namespace {

/// Two spaces count as nested if the residual of the least-squares fit, for a field of order 1, is at most this value. The value is far above
/// round-off and far below the residual of spaces that are not nested.
constexpr double nested = 1e-10;

/// Values of the functions of both spaces at one point.
struct Sample {
  int old_element, new_element;
  double weight;
  Eigen::VectorXd old_basis, new_basis;
};

/// Computes the values of the functions at the 4 x 4 Gauss points of some elements of one space (`from` if `of_from`, otherwise `to`), and finds
/// these points in the other space. If `by_area`, the weights contain the parametric area of the element; otherwise they are the same for all
/// elements.
class Sampling {
 public:
  Sampling(const Space& from, const Space& to) : from_(from), to_(to), in_from_(from), in_to_(to) {}

  std::vector<Sample> at(const std::vector<int>& elements, bool of_from, bool by_area) const {
    std::vector<Sample> samples;
    constexpr double x[4] = {0.069431844202973712, 0.330009478207571868, 0.669990521792428132, 0.930568155797026288};
    constexpr double w[4] = {0.173927422568726929, 0.326072577431273071, 0.326072577431273071, 0.173927422568726929};
    const Space& own = of_from ? from_ : to_;
    for (const int k : elements)
      for (int q = 0; q < 16; ++q) {
        const Site here{k, x[q % 4], x[q / 4]}, there = (of_from ? in_to_ : in_from_)(place(own, here));
        const Site &a = of_from ? here : there, &b = of_from ? there : here;
        const auto& size = own.elements[k].size;
        samples.push_back({a.element, b.element, w[q % 4] * w[q / 4] * (by_area ? size[0] * size[1] : 1),
                           basis(from_.elements[a.element], a.s, a.t, 0).value, basis(to_.elements[b.element], b.s, b.t, 0).value});
      }
    return samples;
  }

  const Space &from_, &to_;
  Locator in_from_, in_to_;
};

Eigen::RowVector3d value(const Eigen::VectorXd& basis, const Element& e, const Net& net) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (std::size_t i = 0; i < e.points.size(); ++i) sum += basis[Eigen::Index(i)] * net.row(e.points[i]);
  return sum;
}

/// Computes some control points of the space `to` by a least-squares fit to a field at sample points; the other control points are given. Uses one
/// sparse Cholesky factorisation for all fields.
class Fit {
 public:
  Fit(const Space& from, const Space& to, std::vector<Sample> samples, std::vector<int> unknown)
      : from_(from), to_(to), samples_(std::move(samples)), unknown_(std::move(unknown)), number_(to.n_points, -1) {
    for (std::size_t i = 0; i < unknown_.size(); ++i) number_[unknown_[i]] = int(i);
    std::map<int, Eigen::MatrixXd> products;  // mass matrix of each element
    for (const Sample& s : samples_) {
      Eigen::MatrixXd& m = products.try_emplace(s.new_element, Eigen::MatrixXd::Zero(s.new_basis.size(), s.new_basis.size())).first->second;
      m.noalias() += s.weight * s.new_basis * s.new_basis.transpose();
    }
    std::deque<std::vector<int>> numbers;
    std::vector<LocalMatrix> local;
    for (auto& [element, m] : products) {
      std::vector<int>& mine = numbers.emplace_back();
      std::vector<Eigen::Index> own;
      for (std::size_t i = 0; i < to.elements[element].points.size(); ++i)
        if (const int n = number_[to.elements[element].points[i]]; n >= 0) mine.push_back(n), own.push_back(Eigen::Index(i));
      m = m(own, own).eval();
      local.push_back({mine, &m});
    }
    if (!unknown_.empty()) factor_.compute(assemble(int(unknown_.size()), local));
  }

  /// Computes the rows of the unknown control points in `net` by a fit to `field`. Returns the distances between `field` and the fit at the sample
  /// points.
  std::vector<double> solve(const Net& field, Net& net) const {
    for (int p : unknown_) net.row(p).setZero();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(Eigen::Index(unknown_.size()), 3);
    for (const Sample& s : samples_) {
      const Element& e = to_.elements[s.new_element];
      const Eigen::RowVector3d rest = s.weight * (value(s.old_basis, from_.elements[s.old_element], field) - value(s.new_basis, e, net));
      for (std::size_t i = 0; i < e.points.size(); ++i)
        if (const int n = number_[e.points[i]]; n >= 0) right.row(n) += s.new_basis[Eigen::Index(i)] * rest;
    }
    if (!unknown_.empty()) right = factor_.solve(right).eval();
    for (std::size_t i = 0; i < unknown_.size(); ++i) net.row(unknown_[i]) = right.row(Eigen::Index(i));
    std::vector<double> distances;
    for (const Sample& s : samples_)
      distances.push_back((value(s.new_basis, to_.elements[s.new_element], net) - value(s.old_basis, from_.elements[s.old_element], field)).norm());
    return distances;
  }

  const std::vector<Sample>& samples() const { return samples_; }

 private:
  const Space &from_, &to_;
  std::vector<Sample> samples_;
  std::vector<int> unknown_, number_;  // number_: index of each control point in unknown_, or -1
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

double largest(const std::vector<double>& numbers) { return numbers.empty() ? 0 : *std::ranges::max_element(numbers); }

/// Transfer of fields to a space that contains the old one.
struct NestedTransfer {
  const Space& from;
  const Space& to;
  Sampling sampling;
  std::vector<int> copied;         // for each new control point, the index of the old control point from which its value is copied; -1 if it is
                                   // fitted
  std::optional<Fit> rest;         // least-squares fit of the control points that are not copied
  mutable std::optional<Fit> all;  // least-squares fit of all control points, created if it is needed

  NestedTransfer(const Space& old_space, const Space& new_space);
  Transferred operator()(const Net& field) const;
};

NestedTransfer::NestedTransfer(const Space& old_space, const Space& new_space)
    : from(old_space), to(new_space), sampling(from, to), copied(to.n_points, -1) {
  std::vector<const Element*> around;  // old element that contains the centre of each new element
  std::vector<char> alike;
  for (const Element& e : to.elements) {
    const Element& c = from.elements[sampling.in_from_({e.face, e.origin[0] + e.size[0] / 2, e.origin[1] + e.size[1] / 2}).element];
    around.push_back(&c);
    alike.push_back(e.degree == c.degree && e.origin == c.origin && e.size == c.size && e.extraction->rows() == c.extraction->rows() &&
                    *e.extraction == *c.extraction);
    if (alike.back())
      for (std::size_t i = 0; i < e.points.size(); ++i) copied[e.points[i]] = c.points[i];
  }
  std::vector<int> changed, unknown;
  for (int k = 0; k < int(to.elements.size()); ++k) {
    const std::vector<int>& points = to.elements[k].points;
    bool same = alike[k];
    for (std::size_t i = 0; same && i < points.size(); ++i) same = copied[points[i]] == around[k]->points[i];
    if (!same) changed.push_back(k);
  }
  for (int p = 0; p < to.n_points; ++p)
    if (copied[p] < 0) unknown.push_back(p);
  if (!changed.empty()) rest.emplace(from, to, sampling.at(changed, false, false), std::move(unknown));
}

Transferred NestedTransfer::operator()(const Net& field) const {
  Transferred out{Net::Zero(to.n_points, 3), 0};
  for (int p = 0; p < to.n_points; ++p)
    if (copied[p] >= 0) out.net.row(p) = field.row(copied[p]);
  if (rest) out.residual = largest(rest->solve(field, out.net));
  if (out.residual <= nested * field.cwiseAbs().maxCoeff()) return out;
  if (!all) all.emplace(from, to, sampling.at(indices(to.elements.size()), false, false), indices(to.n_points));
  out.residual = largest(all->solve(field, out.net));
  return out;
}

}  // namespace

std::function<Transferred(const Net& field)> transfer(const Space& from, const Space& to) {
  return [known = std::make_shared<const NestedTransfer>(from, to)](const Net& field) { return (*known)(field); };
}

std::function<Projected(const Net& field)> projection(const Space& from, const Space& to) {
  const Sampling sampling(from, to);
  std::vector<Sample> samples = sampling.at(indices(from.elements.size()), true, true);
  std::ranges::move(sampling.at(indices(to.elements.size()), false, true), std::back_inserter(samples));
  return [&from, &to, fit = std::make_shared<const Fit>(from, to, std::move(samples), indices(to.n_points))](const Net& field) {
    Projected out{Net::Zero(to.n_points, 3), std::vector<double>(from.elements.size(), 0.0)};
    const std::vector<double> distances = fit->solve(field, out.net);
    for (std::size_t k = 0; k < distances.size(); ++k) {
      double& worst = out.defect[fit->samples()[k].old_element];
      worst = std::max(worst, distances[k]);
    }
    return out;
  };
}

}  // namespace tanktread::spline
