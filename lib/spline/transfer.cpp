#include "spline/transfer.hpp"

#include <algorithm>

#include <Eigen/SparseCholesky>

#include "spline/bernstein.hpp"
#include "spline/locate.hpp"

namespace tanktread::spline {

struct Transfer::State {
  const Space& from;
  const Space& to;
  /// For an element of `to`: the element of `from` around it, and (Bezier points on the fine element) = (row operator) (control points there).
  struct Part {
    int coarse;
    int degree;                   // in which both are compared
    Eigen::MatrixXd coarse_rows;  // (degree + 1)^2 x functions of the coarse element
    Eigen::MatrixXd fine_rows;    // (degree + 1)^2 x functions of the fine element
  };
  std::vector<Part> parts;
  int straddling = 0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
};

namespace {

Eigen::MatrixXd tensor(const Eigen::MatrixXd& s, const Eigen::MatrixXd& t) {
  Eigen::MatrixXd out(s.rows() * t.rows(), s.cols() * t.cols());
  for (Eigen::Index j = 0; j < t.rows(); ++j)
    for (Eigen::Index l = 0; l < t.cols(); ++l) out.block(j * s.rows(), l * s.cols(), s.rows(), s.cols()) = t(j, l) * s;
  return out;
}

Eigen::MatrixXd gather(const Net& field, const std::vector<int>& points) {
  Eigen::MatrixXd out(Eigen::Index(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) out.row(Eigen::Index(i)) = field.row(points[i]);
  return out;
}

}  // namespace

Transfer::Transfer(const Space& from, const Space& to) : state_(new State{from, to, {}, 0, {}}) {
  const Locator locate(from);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(to.elements.size() * 256);
  for (const Element& e : to.elements) {
    State::Part part;
    part.coarse = locate({e.face, e.origin[0] + e.size[0] / 2, e.origin[1] + e.size[1] / 2}).element;
    const Element& c = from.elements[part.coarse];
    double low[2], high[2];
    for (int d = 0; d < 2; ++d) {
      low[d] = (e.origin[d] - c.origin[d]) / c.size[d];
      high[d] = (e.origin[d] + e.size[d] - c.origin[d]) / c.size[d];
    }
    const double margin = 1e-9;
    if (std::min(low[0], low[1]) < -margin || std::max(high[0], high[1]) > 1 + margin) ++state_->straddling;
    part.degree = std::max(e.degree, c.degree);
    const Eigen::MatrixXd up = elevation(c.degree, part.degree);
    part.coarse_rows =
        tensor(up * restriction(c.degree, low[0], high[0]), up * restriction(c.degree, low[1], high[1])) * c.extraction.transpose();
    const Eigen::MatrixXd up_fine = elevation(e.degree, part.degree);
    if (part.degree == e.degree)
      part.fine_rows = e.extraction.transpose();
    else
      part.fine_rows = tensor(up_fine, up_fine) * e.extraction.transpose();
    const Eigen::MatrixXd normal = part.fine_rows.transpose() * part.fine_rows;
    for (std::size_t j = 0; j < e.points.size(); ++j)
      for (std::size_t i = 0; i < e.points.size(); ++i)
        if (e.points[i] >= e.points[j]) entries.emplace_back(e.points[i], e.points[j], normal(Eigen::Index(i), Eigen::Index(j)));
    state_->parts.push_back(std::move(part));
  }
  Eigen::SparseMatrix<double> N(to.n_points, to.n_points);
  N.setFromTriplets(entries.begin(), entries.end());
  state_->factor.compute(N);
}

Transfer::~Transfer() = default;
Transfer::Transfer(Transfer&&) noexcept = default;

int Transfer::straddling() const { return state_->straddling; }

Transfer::Result Transfer::operator()(const Net& field) const {
  const Space& to = state_->to;
  std::vector<Eigen::MatrixXd> target(to.elements.size());
  Net right = Net::Zero(to.n_points, 3);
  for (std::size_t k = 0; k < to.elements.size(); ++k) {
    const auto& part = state_->parts[k];
    target[k] = part.coarse_rows * gather(field, state_->from.elements[part.coarse].points);
    const Eigen::MatrixXd r = part.fine_rows.transpose() * target[k];
    for (std::size_t i = 0; i < to.elements[k].points.size(); ++i) right.row(to.elements[k].points[i]) += r.row(Eigen::Index(i));
  }
  Result out{Net(to.n_points, 3), 0};
  for (int d = 0; d < 3; ++d) out.net.col(d) = state_->factor.solve(Eigen::VectorXd(right.col(d)));
  for (std::size_t k = 0; k < to.elements.size(); ++k)
    out.residual =
        std::max(out.residual, (state_->parts[k].fine_rows * gather(out.net, to.elements[k].points) - target[k]).cwiseAbs().maxCoeff());
  return out;
}

}  // namespace tanktread::spline
