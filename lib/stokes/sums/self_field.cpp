#include "stokes/sums/self_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

#include "base/threads.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"
#include "stokes/sums/layer_rule.hpp"

namespace tanktread::stokes {
namespace {

/// Returns the number of radial points of a polar rule for a tolerance. Few points suffice, because the integrand is smooth along a ray. The number
/// was chosen from errors measured on cube meshes with at least 3 elements per side (tests/verify/layers.cpp).
int radial_points(double tolerance) { return std::max(4, static_cast<int>(std::ceil(-std::log10(tolerance))) - 1); }

/// Returns the permitted distance of an element's corner from the position that the tangents at the target predict, divided by the distance of the
/// corner from the target. If the corner is farther from this position, more quadrature points are used. The permitted distance decreases with the
/// tolerance. The constants were chosen from errors on spheroids of aspect ratio 10 (tests/verify/layer_shapes.cpp), whose tip radius is as small as
/// their elements.
double distortion_allowed(double tolerance) { return 0.5 * std::min(1., std::pow(1e4 * tolerance, 1. / 6)); }

/// Number of kept rules (most_tables), or of the points of all kept rules (most_points, 136 bytes each), beyond which the rules are discarded. The
/// limit is needed because metrics change in a long run, and a strongly deformed shape may need rules of 25,000 points.
constexpr std::size_t most_tables = 1000, most_points = 1'000'000;

/// Number of sites whose rules are made before the limit is compared again, and number of sites whose metrics a thread computes at a time.
constexpr std::size_t sites_at_a_time = 256, sites_of_block = 16;

/// Returns sum_ij B_i(s) B_j(t) p_ij for the Bezier points p_ij. Terms with B_i = 0 or B_j = 0 are skipped: at corners and on sides of a panel these
/// are most of them.
Vec3 product(const double* bs, const double* bt, int n, const double* bezier) {
  Vec3 sum = Vec3::Zero();
  for (int j = 0; j < n; ++j) {
    if (bt[j] == 0) continue;
    for (int i = 0; i < n; ++i) {
      if (bs[i] == 0) continue;
      for (int c = 0; c < 3; ++c) sum[c] += bs[i] * bt[j] * bezier[n * n * c + n * j + i];
    }
  }
  return sum;
}

/// Evaluates the Bernstein polynomials for a pair of site and panel if they are not yet stored. For the first panel of a site they are evaluated at
/// construction. For all other panels they are evaluated at first use, because only the rank that owns the target needs them.
void set_polynomials(SelfPair& pair, int degree) {
  if (!pair.bernstein.empty()) return;
  const int n = degree + 1;
  pair.bernstein.resize(static_cast<std::size_t>(4) * n);
  double* b = pair.bernstein.data();
  spline::bernstein(degree, pair.s, b, b + 2 * n, nullptr);
  spline::bernstein(degree, pair.t, b + n, b + 3 * n, nullptr);
}

}  // namespace

SelfField::SelfField(const spline::Space& space, const Sites& sites, const quadrature::Options& options)
    : options_(options), radial_(radial_points(options.tolerance)), first_{0} {
  std::size_t pairs = 0;
  for (const auto& places : sites) pairs += places.size();
  pairs_.reserve(pairs);
  for (const auto& places : sites) {
    for (const spline::Site& site : places) {
      SelfPair& pair = pairs_.emplace_back();
      pair.panel = site.element, pair.s = site.s, pair.t = site.t;
      if (&site == &places.front()) set_polynomials(pair, space.elements[site.element].degree);
    }
    first_.push_back(pairs_.size());
  }
}

/// Sets the metric of a pair and the orders of its rule for the current shape. If they have changed, discards the rule and the weights of the pair.
void SelfField::choose(SelfPair& pair, const Panels& panels, const std::vector<double>& bezier) const {
  const int degree = panels[pair.panel].table->degree, n = degree + 1;
  set_polynomials(pair, degree);
  quadrature::MetricBin bin;
  quadrature::PolarOrders orders;
  if (properties(options_.rule).follows_tolerance) {
    const double *b = pair.bernstein.data(), *points = &bezier[panels[pair.panel].first_bezier];
    const Vec3 a1 = product(b + 2 * n, b + n, n, points), a2 = product(b, b + 3 * n, n, points);
    bin = quadrature::metric_bin(a1.dot(a1), a1.dot(a2), a2.dot(a2));
    const double squares[2] = {a1.squaredNorm(), a2.squaredNorm()};
    if (std::min(squares[0], squares[1]) < 1e-20 * std::max(squares[0], squares[1]))
      orders.radial = 2 * radial_;  // a side is collapsed to a point, so that the area element vanishes like r and the integrand is not singular
    else
      orders = raised_orders(pair, degree, points, bin, a1, a2);
  }
  if (pair.table && bin == pair.bin && orders == pair.orders) return;
  pair.bin = bin, pair.orders = orders;
  pair.weights.clear();
  pair.table = nullptr;
}

/// Sets the rules of the pairs of the first sites. Returns the number of these sites: as many as there is memory for rules, and a multiple of
/// `multiple` unless it is all of them.
std::size_t SelfField::prepare(std::span<const int> sites, std::size_t multiple, const Panels& panels, const std::vector<double>& bezier) {
  if (!properties(options_.rule).has_singular_rules) return sites.size();
  const auto key = [&](const SelfPair& pair) { return Key{panels[pair.panel].table->degree, pair.s, pair.t, pair.bin, pair.orders}; };
  const std::size_t at_a_time = multiple * ((sites_at_a_time + multiple - 1) / multiple);
  for (std::size_t first = 0; first < sites.size(); first += at_a_time) {
    const std::span<const int> some = sites.subspan(first, std::min(at_a_time, sites.size() - first));
    each_block(some.size(), sites_of_block, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        for (SelfPair& pair : (*this)[some[k]]) choose(pair, panels, bezier);
    });
    std::vector<SelfPair*> missing;
    const auto look_up = [&] {
      for (const int i : some)
        for (SelfPair& pair : (*this)[i]) {
          if (pair.table) continue;
          if (const auto found = tables_.find(key(pair)); found != tables_.end()) pair.table = found->second.get();
          else missing.push_back(&pair);
        }
    };
    look_up();
    if (!missing.empty() && (tables_.size() > most_tables || points_ > most_points)) {
      if (first > 0) return first;
      forget_rules();
      missing.clear();
      look_up();
    }
    std::vector<std::pair<const SelfPair*, PointTable*>> fresh;
    for (SelfPair* pair : missing) {
      std::unique_ptr<PointTable>& table = tables_[key(*pair)];
      if (!table) fresh.emplace_back(pair, (table = std::make_unique<PointTable>()).get());
      pair->table = table.get();
    }
    each_item(fresh.size(), [&](std::size_t k) { fill(*fresh[k].first, panels[fresh[k].first->panel].table->degree, *fresh[k].second); });
    for (const auto& [pair, table] : fresh) points_ += static_cast<std::size_t>(table->points);
  }
  return sites.size();
}

/// Returns higher orders of the polar rule for a distorted element. Returns zeros if the corners of the element are close to the positions predicted
/// by the tangents a1, a2 at the site.
quadrature::PolarOrders SelfField::raised_orders(const SelfPair& pair, int degree, const double* bezier, quadrature::MetricBin bin,
                                                 const Vec3& a1, const Vec3& a2) const {
  const int n = degree + 1, n_b = n * n;
  const int at[4] = {0, degree, n_b - 1, n_b - n};
  const Vec3 x0 = product(pair.bernstein.data(), pair.bernstein.data() + n, n, bezier);
  std::array<Vec3, 4> corner, affine;
  const double allowed = std::pow(distortion_allowed(options_.tolerance), 2), rounding = 1e-20 * (a1.squaredNorm() + a2.squaredNorm());
  bool distorted = false;
  for (int k = 0; k < 4; ++k) {
    corner[k] = Vec3(bezier[at[k]], bezier[n_b + at[k]], bezier[2 * n_b + at[k]]) - x0;
    affine[k] = ((k == 1 || k == 2) - pair.s) * a1 + ((k == 2 || k == 3) - pair.t) * a2;
    distorted |= (corner[k] - affine[k]).squaredNorm() > allowed * corner[k].squaredNorm() + rounding;
  }
  if (!distorted) return {};
  return quadrature::polar_orders(pair.s, pair.t, bin, radial_, options_.tolerance, corner, affine);
}

/// Makes the rule of a pair.
void SelfField::fill(const SelfPair& pair, int degree, PointTable& table) const {
  const auto& [s, t, bin, orders] = std::tie(pair.s, pair.t, pair.bin, pair.orders);
  if (!properties(options_.rule).follows_tolerance)
    tabulate(quadrature::lachat_watson(s, t, options_.points), degree, table);
  else if (!orders.radial)
    tabulate(quadrature::polar(s, t, bin, quadrature::polar_orders(s, t, bin, radial_, options_.tolerance)), degree, table);
  else if (orders.angular == std::array<int, 4>{})
    tabulate(quadrature::Rule(quadrature::tensor_gauss(orders.radial)), degree, table);
  else
    tabulate(quadrature::polar(s, t, bin, orders), degree, table);
}

void SelfField::forget_rules() {
  for (SelfPair& pair : pairs_) pair.table = nullptr, pair.weights.clear();
  tables_.clear();
  points_ = 0;
}

void SelfField::forget_weights() {
  for (SelfPair& pair : pairs_) pair.weights.clear();
}

Vec3 SelfField::value(int i, const Panels& panels, const std::vector<double>& bezier) const {
  const SelfPair& pair = pairs_[first_[i]];
  const int n = panels[pair.panel].table->degree + 1;
  const double* b = pair.bernstein.data();
  return product(b, b + n, n, &bezier[panels[pair.panel].first_bezier]);
}

std::pair<Vec3, Vec3> SelfField::tangents(int i, const Panels& panels, const std::vector<double>& bezier) const {
  const SelfPair& pair = pairs_[first_[i]];
  const int n = panels[pair.panel].table->degree + 1;
  const double *b = pair.bernstein.data(), *points = &bezier[panels[pair.panel].first_bezier];
  return {product(b + 2 * n, b + n, n, points), product(b, b + 3 * n, n, points)};
}

std::pair<int, Eigen::VectorXd> SelfField::basis(int i, const Panels& panels) const {
  const SelfPair& pair = pairs_[first_[i]];
  const Panel& panel = panels[pair.panel];
  const int n = panel.table->degree + 1, n_b = n * n;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(panel.functions);
  const double* extraction = panels.extraction(pair.panel);
  for (int a = 0; a < panel.functions; ++a)
    for (int b = 0; b < n_b; ++b) values[a] += extraction[n_b * a + b] * pair.bernstein[b % n] * pair.bernstein[n + b / n];
  return {pair.panel, values};
}

}  // namespace tanktread::stokes
