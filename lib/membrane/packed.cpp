#include "membrane/packed.hpp"

#include <algorithm>
#include <cassert>
#include <map>
#include <numeric>
#include <utility>

#include "base/kept_once.hpp"
#include "base/threads.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::membrane {
namespace {

Group group_with_rule(int degree, int order) {
  Group g;
  assert(degree <= spline::largest_degree && order <= max_order);
  g.degree = degree;
  g.order = order;
  const auto& rule = quadrature::gauss(order);
  const int width = degree + 1;
  g.value.resize(order * width);
  g.slope.resize(order * width);
  g.bend.resize(order * width);
  for (int q = 0; q < order; ++q) spline::bernstein(degree, rule.nodes[q], &g.value[q * width], &g.slope[q * width], &g.bend[q * width]);
  for (int qt = 0; qt < order; ++qt)
    for (int qs = 0; qs < order; ++qs) g.weight.push_back(rule.weights[qt] * rule.weights[qs]);
  return g;
}

void append(Group& g, const spline::Space& space, std::span<const int> elements, Tables& extractions) {
  Batch batch;
  const int lanes = pack_lanes();
  batch.used = static_cast<int>(elements.size());
  for (int l = 0; l < lanes; ++l) batch.elements[l] = elements[std::min(l, batch.used - 1)];
  for (int e : elements) batch.functions = std::max(batch.functions, static_cast<int>(space.elements[e].points.size()));
  assert(batch.functions <= spline::most_functions);
  batch.points = g.points.size();
  batch.extraction = g.extraction.size();
  g.points.resize(batch.points + batch.functions * lanes, 0);
  g.extraction.resize(batch.extraction + batch.functions * g.n_bernstein(), Pack{});
  double* const extraction = numbers(&g.extraction[batch.extraction]);
  for (int l = 0; l < lanes; ++l) {
    const spline::Element& element = space.elements[batch.elements[l]];
    for (int a = 0; a < static_cast<int>(element.points.size()); ++a) {
      g.points[batch.points + a * lanes + l] = element.points[a];
      for (int b = 0; b < g.n_bernstein(); ++b) extraction[lanes * (a * g.n_bernstein() + b) + l] = (*element.extraction)(a, b);
    }
  }
  batch.extraction = kept_once(g.extraction, batch.extraction, extractions);
  g.batches.push_back(batch);
}

}  // namespace

std::vector<Group> pack(const spline::Space& space, std::span<const int> elements, int order, std::span<const int> material) {
  std::map<std::pair<int, int>, std::vector<int>> alike;
  for (int e : elements) alike[{material.empty() ? 0 : material[e], space.elements[e].degree}].push_back(e);
  std::vector<Group> groups;
  const std::size_t lanes = pack_lanes();
  for (auto& [kind, list] : alike) {
    std::sort(list.begin(), list.end());
    Group& g = groups.emplace_back(group_with_rule(kind.second, quadrature::gauss_order(order, kind.second)));
    g.material = kind.first;
    Tables extractions;
    for (std::size_t first = 0; first < list.size(); first += lanes)
      append(g, space, std::span(list).subspan(first, std::min(lanes, list.size() - first)), extractions);
  }
  return groups;
}

void add_transpose(const Group& group, const Batch& batch, const Pack* p, Net& sum) {
  double rows[3 * spline::most_functions * most_lanes];
  transpose(group, batch, p, rows);
  for (int l = 0; l < batch.used; ++l)
    for (int a = 0; a < batch.functions; ++a)
      for (int c = 0; c < 3; ++c) sum(group.points[batch.points + a * pack_lanes() + l], c) += rows[3 * (l * batch.functions + a) + c];
}

PointSums::PointSums(const spline::Space& space, std::vector<Group>& groups) : first_(static_cast<std::size_t>(space.n_points) + 1, 0) {
  const auto each_row = [&](const auto& use) {
    n_rows_ = 0;
    for (Group& group : groups)
      for (Batch& batch : group.batches) {
        batch.row = n_rows_;
        for (int l = 0; l < batch.used; ++l, n_rows_ += static_cast<std::size_t>(batch.functions)) {
          const std::vector<int>& points = space.elements[batch.elements[l]].points;
          for (std::size_t a = 0; a < points.size(); ++a) use(points[a], n_rows_ + a);
        }
      }
  };
  each_row([&](int point, std::size_t) { ++first_[static_cast<std::size_t>(point) + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  row_.resize(first_.back());
  std::vector<std::size_t> next = first_;
  each_row([&](int point, std::size_t row) { row_[next[static_cast<std::size_t>(point)]++] = static_cast<int>(row); });
}

void PointSums::add(const double* rows, Net& sum) const {
  constexpr std::size_t points_at_a_time = 512;
  each_block(first_.size() - 1, points_at_a_time, [&](std::size_t begin, std::size_t end) {
    for (std::size_t point = begin; point < end; ++point) {
      double* const to = sum.data() + 3 * point;
      for (std::size_t k = first_[point]; k < first_[point + 1]; ++k)
        for (std::size_t c = 0; c < 3; ++c) to[c] += rows[3 * static_cast<std::size_t>(row_[k]) + c];
    }
  });
}

}  // namespace tanktread::membrane
