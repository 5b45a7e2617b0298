#include "stokes/sums/panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/kept_once.hpp"
#include "base/threads.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "stokes/kernels/panel_kernel.hpp"

namespace tanktread::stokes {
namespace {

NodeTable table(int degree, int order) {
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(order);
  const auto [value, s, t] = spline::tensor_bernstein(degree, rule.s, rule.t);
  const auto numbers = [](const auto& a) { return std::vector<double>(a.data(), a.data() + a.size()); };
  return {degree, order, (degree + 1) * (degree + 1), rule.size(), numbers(value), numbers(s), numbers(t), numbers(rule.weights)};
}

}  // namespace

Panels::Panels(const spline::Space& space, const std::vector<int>& orders) {
  Tables extractions;
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const spline::Element& element = space.elements[e];
    auto found = std::find_if(tables_.begin(), tables_.end(),
                              [&](const NodeTable& t) { return t.degree == element.degree && t.order == orders[e]; });
    if (found == tables_.end()) found = tables_.insert(tables_.end(), table(element.degree, orders[e]));
    const int m = static_cast<int>(element.points.size());
    const std::size_t first = extraction_.size();
    for (int a = 0; a < m; ++a)
      for (int b = 0; b < found->n_bernstein; ++b) extraction_.push_back((*element.extraction)(a, b));
    panels_.push_back({&*found, m, points_.size(), kept_once(extraction_, first, extractions), bezier_size_, n_nodes_});
    points_.insert(points_.end(), element.points.begin(), element.points.end());
    n_nodes_ += found->n_nodes;
    bezier_size_ += static_cast<std::size_t>(3) * found->n_bernstein;
  }
}

void Panels::bezier(const Net& net, std::vector<double>& points) const {
  points.resize(bezier_size_);
  each_block(size(), panel_block, [&](int first, int last) {
    for (int e = first; e < last; ++e) {
      const Panel& p = panels_[e];
      extract(p.table->n_bernstein, p.functions, this->points(e), extraction(e), net.data(), &points[p.first_bezier]);
    }
  });
}

void node_values(const Panels& panels, const std::vector<double>& bezier, std::vector<double> (&value)[3]) {
  for (auto& component : value) component.resize(panels.n_nodes());
  each_block(panels.size(), panel_block, [&](int first, int last) {
    for (int e = first; e < last; ++e) {
      const NodeTable& t = *panels[e].table;
      for (int c = 0; c < 3; ++c)
        combine(t.n_bernstein, t.n_nodes, t.value.data(), &bezier[panels[e].first_bezier + c * t.n_bernstein], &value[c][panels[e].first_node]);
    }
  });
}

namespace {

/// Computes the weighted normals of one panel: normal[c] points to component c at the first node of the panel. `scratch`: memory for tangents.
void panel_normals(const Panel& panel, const double* bezier, std::vector<double>& scratch, const std::array<double*, 3>& normal) {
  const NodeTable& t = *panel.table;
  scratch.resize(static_cast<std::size_t>(6) * t.n_nodes);
  for (int c = 0; c < 3; ++c) {
    combine(t.n_bernstein, t.n_nodes, t.along_s.data(), bezier + c * t.n_bernstein, &scratch[c * t.n_nodes]);
    combine(t.n_bernstein, t.n_nodes, t.along_t.data(), bezier + c * t.n_bernstein, &scratch[(3 + c) * t.n_nodes]);
  }
  weigh_normals(t.n_nodes, scratch.data(), t.weights.data(), normal[0], normal[1], normal[2]);
}

}  // namespace

void node_normals(const Panels& panels, const std::vector<double>& bezier, std::vector<double> (&normal)[3]) {
  for (auto& component : normal) component.resize(panels.n_nodes());
  each_block(panels.size(), panel_block, [&](int first, int last) {
    std::vector<double> scratch;
    for (int e = first; e < last; ++e) {
      const int node = panels[e].first_node;
      panel_normals(panels[e], &bezier[panels[e].first_bezier], scratch, {&normal[0][node], &normal[1][node], &normal[2][node]});
    }
  });
}

void node_weights(const Panels& panels, int e, const std::vector<double>& bezier, std::vector<double>& weight) {
  const int n = panels[e].table->n_nodes;
  std::vector<double> scratch, normal(static_cast<std::size_t>(3) * n);
  panel_normals(panels[e], &bezier[panels[e].first_bezier], scratch, {&normal[0], &normal[n], &normal[2 * n]});
  for (int k = 0; k < n; ++k)
    weight[panels[e].first_node + k] = std::sqrt(normal[k] * normal[k] + normal[n + k] * normal[n + k] + normal[2 * n + k] * normal[2 * n + k]);
}

void node_weights(const Panels& panels, const std::vector<double>& bezier, std::vector<double>& weight) {
  weight.resize(panels.n_nodes());
  each_block(panels.size(), panel_block, [&](int first, int last) {
    for (int e = first; e < last; ++e) node_weights(panels, e, bezier, weight);
  });
}

}  // namespace tanktread::stokes
