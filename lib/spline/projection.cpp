#include "spline/projection.hpp"

#include <algorithm>

#include <Eigen/SparseCholesky>

#include "spline/basis.hpp"
#include "spline/locate.hpp"
#include "spline/normal_matrix.hpp"

namespace tanktread::spline {

struct Projection::State {
  const Space& from;
  const Space& to;
  struct Sample {
    int old_element, new_element;
    double weight;
    Eigen::VectorXd old_basis, new_basis;
  };
  std::vector<Sample> samples;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
};

Projection::Projection(const Space& from, const Space& to) : state_(new State{from, to, {}, {}}) {
  // Gauss points and weights of order four on [0, 1].
  constexpr double x[4] = {0.069431844202973712, 0.330009478207571868, 0.669990521792428132, 0.930568155797026288};
  constexpr double w[4] = {0.173927422568726929, 0.326072577431273071, 0.326072577431273071, 0.173927422568726929};
  const Locator in_from(from), in_to(to);
  auto sample = [&](const Space& own, const Locator& other, bool own_is_from) {
    for (int k = 0; k < int(own.elements.size()); ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i) {
          const Site here{k, x[i], x[j]}, there = other(place(own, here));
          const Site &a = own_is_from ? here : there, &b = own_is_from ? there : here;
          const auto& size = own.elements[k].size;
          state_->samples.push_back({a.element, b.element, w[i] * w[j] * size[0] * size[1],
                                     basis(from.elements[a.element], a.s, a.t, 0).value, basis(to.elements[b.element], b.s, b.t, 0).value});
        }
  };
  sample(from, in_to, true);
  sample(to, in_from, false);

  std::vector<LocalMatrix> local(to.elements.size());
  for (std::size_t k = 0; k < local.size(); ++k) local[k].unknowns = to.elements[k].points;
  for (const auto& s : state_->samples) {
    auto& m = local[s.new_element].values;
    if (m.size() == 0) m = Eigen::MatrixXd::Zero(s.new_basis.size(), s.new_basis.size());
    m.noalias() += s.weight * s.new_basis * s.new_basis.transpose();
  }
  state_->factor.compute(assemble(to.n_points, local));
}

Projection::~Projection() = default;
Projection::Projection(Projection&&) noexcept = default;

Projection::Result Projection::operator()(const Net& field) const {
  const auto& s = *state_;
  std::vector<Eigen::RowVector3d> old(s.samples.size());
  Net right = Net::Zero(s.to.n_points, 3);
  for (std::size_t k = 0; k < s.samples.size(); ++k) {
    const auto& sample = s.samples[k];
    old[k].setZero();
    const auto& from = s.from.elements[sample.old_element].points;
    for (std::size_t i = 0; i < from.size(); ++i) old[k] += sample.old_basis[Eigen::Index(i)] * field.row(from[i]);
    const auto& to = s.to.elements[sample.new_element].points;
    for (std::size_t i = 0; i < to.size(); ++i) right.row(to[i]) += sample.weight * sample.new_basis[Eigen::Index(i)] * old[k];
  }
  Result out{Net(s.to.n_points, 3), std::vector<double>(s.from.elements.size(), 0.0)};
  for (int d = 0; d < 3; ++d) out.net.col(d) = s.factor.solve(Eigen::VectorXd(right.col(d)));
  for (std::size_t k = 0; k < s.samples.size(); ++k) {
    const auto& sample = s.samples[k];
    Eigen::RowVector3d now = Eigen::RowVector3d::Zero();
    const auto& to = s.to.elements[sample.new_element].points;
    for (std::size_t i = 0; i < to.size(); ++i) now += sample.new_basis[Eigen::Index(i)] * out.net.row(to[i]);
    double& worst = out.defect[sample.old_element];
    worst = std::max(worst, (now - old[k]).norm());
  }
  return out;
}

}  // namespace tanktread::spline
