#include "stokes/medium/periodic_sum.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/threads.hpp"

namespace tanktread::stokes {

namespace {

/// Rounds the extent outwards in the directions that are not periodic, to multiples of a step. The step is between an eighth and a quarter of the
/// length of the extent. A moving shape then seldom needs a new table. The rounded extent depends only on the current shape, not on earlier ones.
std::array<Vec3, 2> rounded(const PeriodicCell& cell, std::array<Vec3, 2> extent) {
  for (int d = cell.n(); d < 3; ++d) {
    const double step = std::exp2(std::floor(std::log2(extent[1][d] - extent[0][d]))) / 4;
    extent[0][d] = step * std::floor(extent[0][d] / step), extent[1][d] = step * std::ceil(extent[1][d] / step);
  }
  return extent;
}

/// Returns, for each lattice vector, the number of steps in both directions up to which images are near. Also returns the distance of the nearest
/// image that is not near. For any two points in the box, this distance is at least about `far` box lengths.
std::pair<std::array<int, 3>, double> near_steps(const PeriodicCell& cell, const Mat3& box, double far) {
  const double longest = box.colwise().norm().maxCoeff();
  std::array<int, 3> steps{0, 0, 0};
  double distance = 1e300;
  for (int d = 0; d < cell.n(); ++d) {
    const double spacing = cell.spacing(d);
    int& n = steps[static_cast<std::size_t>(d)];
    n = std::max(1, static_cast<int>(std::ceil(far * longest / spacing - 0.3)));
    distance = std::min(distance, n * spacing);
  }
  return {steps, distance};
}

/// Returns the tolerance, reduced for the stresslet. The stresslet is singular by one order more than the Stokeslet. On cubic, tilted and oblong
/// cells, the error of the stresslet sum was up to three times as large as the error of the Stokeslet sum.
double tolerance_of(double tolerance, PeriodicKernel::Kind kind) { return kind == PeriodicKernel::Kind::stresslet ? tolerance / 5 : tolerance; }

/// Returns the number of Chebyshev nodes on [-1, 1] for interpolation to this tolerance of a function whose nearest poles are at the imaginary
/// numbers +-iy.
int order_for(double tolerance, double y) { return static_cast<int>(std::ceil(-std::log(tolerance) / std::asinh(y))); }

std::vector<double> chebyshev(int n) {
  std::vector<double> nodes;
  for (int a = 0; a < n; ++a) nodes.push_back(std::cos(std::numbers::pi * (2 * a + 1) / (2 * n)));
  return nodes;
}

/// Returns the matrix that maps values at Chebyshev nodes to values at other positions, by the barycentric formula.
Eigen::MatrixXd interpolation(const std::vector<double>& places, const std::vector<double>& nodes) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd result(static_cast<Eigen::Index>(places.size()), n);
  for (std::size_t i = 0; i < places.size(); ++i) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n);
    for (Eigen::Index a = 0; a < n; ++a) {
      const double apart = places[i] - nodes[static_cast<std::size_t>(a)];
      if (apart == 0) {
        row.setZero();
        row[a] = 1;
        break;
      }
      row[a] = (a % 2 ? -1 : 1) * std::sin(std::numbers::pi * (2. * static_cast<double>(a) + 1) / (2. * static_cast<double>(n))) / apart;
    }
    result.row(static_cast<Eigen::Index>(i)) = row / row.sum();
  }
  return result;
}

/// Returns the distinct values of (b - a)/2 for all pairs of node coordinates a, b in [-1, 1]. `number`: for each pair, the index of its value, with
/// b running fastest.
std::vector<double> differences(const std::vector<double>& nodes, std::vector<int>& number) {
  std::vector<double> all;
  for (const double a : nodes)
    for (const double b : nodes) {
      const double d = (b - a) / 2;
      const auto known = std::ranges::find_if(all, [&](double other) { return std::abs(other - d) < 1e-13; });
      number.push_back(static_cast<int>(known - all.begin()));
      if (known == all.end()) all.push_back(d);
    }
  return all;
}

/// Interpolates values [component][x][y][z] at nodes to values [x][y][z][component] at other positions. by[d]: values of the interpolation functions
/// of direction d, shape (positions, nodes).
std::vector<double> interpolated(std::vector<double> values, const std::array<Eigen::MatrixXd, 3>& by) {
  const auto contract = [&](const Eigen::MatrixXd& matrix) {  // multiplies by a matrix along the last index, and moves this index to the front
    const Eigen::Index rest = static_cast<Eigen::Index>(values.size()) / matrix.cols();
    const Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(values.data(), matrix.cols(), rest).transpose() * matrix.transpose();
    values.assign(result.data(), result.data() + result.size());
  };
  for (int d = 2; d >= 0; --d) contract(by[static_cast<std::size_t>(d)]);
  return values;
}

/// Returns the kernel's components reordered: for each component of the source strength, the three components of the velocity that it produces,
/// contiguous and padded to four.
std::vector<double> columns(PeriodicKernel::Kind kind, const std::vector<double>& components, int n) {
  constexpr int number[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  const int in = kind == PeriodicKernel::Kind::stokeslet ? 3 : 6;
  const std::size_t places = components.size() / static_cast<std::size_t>(n);
  std::vector<double> result(4 * static_cast<std::size_t>(in) * places, 0.);
  for (std::size_t k = 0; k < places; ++k)
    for (int c = 0; c < in; ++c)
      for (int i = 0; i < 3; ++i)
        result[static_cast<std::size_t>(4 * in) * k + static_cast<std::size_t>(4 * c + i)] =
            components[static_cast<std::size_t>(n) * k + static_cast<std::size_t>(in == 3 ? number[3 * i + c] : 6 * i + c)];
  return result;
}

/// Data of PeriodicSum (difference_, differences_, box_.order) that give the table index of the difference between two interpolation nodes.
struct Differences {
  const std::array<std::vector<int>, 3>* number;
  const std::array<std::size_t, 3>* many;
  std::array<int, 3> order;
};

/// Returns the velocity at node a due to the source `strengths` of all nodes, with In components per node.
template <int In>
Eigen::Array4d product(const Differences& of, const double* table, int a, const double* strengths) {
  const auto& [n0, n1, n2] = of.order;
  const int* along[3] = {&(*of.number)[0][static_cast<std::size_t>(n0 * (a % n0))], &(*of.number)[1][static_cast<std::size_t>(n1 * (a / n0 % n1))],
                         &(*of.number)[2][static_cast<std::size_t>(n2 * (a / (n0 * n1)))]};
  const int rows = static_cast<int>((*of.many)[1]), columns = static_cast<int>((*of.many)[2]);
  Eigen::Array4d sum = Eigen::Array4d::Zero();
  for (int b2 = 0; b2 < n2; ++b2)
    for (int b1 = 0; b1 < n1; ++b1)
      for (int b0 = 0; b0 < n0; ++b0, strengths += In) {
        const double* t = table + 4 * In * static_cast<std::ptrdiff_t>((along[0][b0] * rows + along[1][b1]) * columns + along[2][b2]);
        for (int c = 0; c < In; ++c) sum += Eigen::Map<const Eigen::Array4d>(t + 4 * c) * strengths[c];
      }
  return sum;
}

}  // namespace

PeriodicSum::PeriodicSum(PeriodicKernel::Kind kind, const PeriodicCell& cell, double asked, const std::array<Vec3, 2>& extent)
    : kind_(kind), cell_(cell), away_(Vec3::Zero()), low_(Vec3::Constant(-0.5)), length_(Vec3::Ones()), across_(rounded(cell, extent)) {
  const double tolerance = tolerance_of(asked, kind);
  double highest = 0;
  for (int d = cell.n(); d < 3; ++d) highest = std::max({highest, std::abs(across_[0][d]), std::abs(across_[1][d])});
  for (int d = 0; d < 3; ++d) away_ += (d < cell.n() ? 5 : 5 * highest) * cell.vectors().col(d);
  Mat3 box = cell.vectors();
  for (int d = cell.n(); d < 3; ++d) {
    length_[d] = across_[1][d] - across_[0][d];
    low_[d] = across_[0][d];
    box.col(d) *= length_[d];
  }
  low_ += cell.coordinates(away_);
  std::array<int, 3> steps{};
  double distance = 0;
  for (int far = 1; far < 9; ++far) {
    std::tie(steps, distance) = near_steps(cell, box, far);
    int most = 0;
    for (int d = 0; d < 3; ++d) most = std::max(most, order_for(tolerance, 2 * distance / box.col(d).norm()));
    if (most <= std::min(7 + 3 * far, most_chebyshev)) break;
  }
  images_ = cell.around(steps);
  std::array<std::vector<double>, 3> nodes, places;
  std::array<Eigen::MatrixXd, 3> to_places;
  for (std::size_t d = 0; d < 3; ++d) {
    const double length = box.col(static_cast<Eigen::Index>(d)).norm();
    box_.half[d] = 0.5;
    box_.order[d] = std::clamp(order_for(tolerance, 2 * distance / length), 2, most_chebyshev);
    nodes[d] = chebyshev(std::clamp(order_for(tolerance, distance / length), 2, 40));
    places[d] = differences(chebyshev(box_.order[d]), difference_[d]);
    differences_[d] = places[d].size();
    to_places[d] = interpolation(places[d], nodes[d]);
  }
  const PeriodicKernel kernel(kind, cell, box, steps, tolerance);
  table_ = columns(kind, interpolated(kernel.values(nodes), to_places), kernel.components());
  components_ = kind == PeriodicKernel::Kind::stokeslet ? 12 : 24;
}

bool PeriodicSum::suits(const std::array<Vec3, 2>& extent) const {
  const std::array<Vec3, 2> across = rounded(cell_, extent);
  for (int d = cell_.n(); d < 3; ++d)
    if (across[0][d] != across_[0][d] || across[1][d] != across_[1][d]) return false;
  return true;
}

Vec3 PeriodicSum::in_box(const Vec3& wrapped) const {
  const Vec3 s = (cell_.coordinates(wrapped) - low_).cwiseQuotient(length_) - Vec3::Constant(0.5);
  assert(!(s.array().abs() > 0.5 + 1e-8).any() && "positions are wrapped(), and within the extent");  // true for NaN
  return s;
}

/// Computes the velocities u at the nodes, stored in blocks of far_block nodes, from the source strengths q at the nodes.
void PeriodicSum::apply(const std::vector<double> (&q)[6], std::vector<double>& u) const {
  const int n = box_.n_nodes();
  const std::size_t in = static_cast<std::size_t>(components_) / 4;
  std::vector<double> strengths;
  for (std::size_t b = 0; b < static_cast<std::size_t>(n); ++b)
    for (std::size_t c = 0; c < in; ++c) strengths.push_back(q[c][b]);
  const Differences from{&difference_, &differences_, box_.order};
  each_item(n, [&](int a) {
    const Eigen::Array4d sum = in == 3 ? product<3>(from, table_.data(), a, strengths.data()) : product<6>(from, table_.data(), a, strengths.data());
    for (int i = 0; i < 3; ++i) u[static_cast<std::size_t>(far_block * (3 * (a / far_block) + i) + a % far_block)] = sum[i];
  });
}

Eigen::MatrixXd PeriodicSum::lagrange(std::span<const Vec3> places) const {
  std::array<Eigen::MatrixXd, 3> along;
  for (std::size_t d = 0; d < 3; ++d) {
    std::vector<double> at;
    for (const Vec3& x : places) at.push_back(2 * in_box(x)[static_cast<Eigen::Index>(d)]);
    along[d] = interpolation(at, chebyshev(box_.order[d]));
  }
  Eigen::MatrixXd all(static_cast<Eigen::Index>(places.size()), n_nodes());
  const auto [n0, n1, n2] = box_.order;
  for (int c = 0; c < n2; ++c)
    for (int b = 0; b < n1; ++b)
      for (int a = 0; a < n0; ++a)
        all.col(a + n0 * (b + n1 * c)) = along[0].col(a).cwiseProduct(along[1].col(b)).cwiseProduct(along[2].col(c));
  return all;
}

Eigen::MatrixXd PeriodicSum::between_nodes(int component) const {
  constexpr int entry[6] = {0, 1, 2, 5, 6, 10};  // 4 column + row
  const auto [n0, n1, n2] = box_.order;
  const int n = n_nodes(), rows = static_cast<int>(differences_[1]), columns = static_cast<int>(differences_[2]);
  Eigen::MatrixXd all(n, n);
  for (int b = 0; b < n; ++b)
    for (int a = 0; a < n; ++a) {
      const int d0 = difference_[0][static_cast<std::size_t>(n0 * (a % n0) + b % n0)];
      const int d1 = difference_[1][static_cast<std::size_t>(n1 * (a / n0 % n1) + b / n0 % n1)];
      const int d2 = difference_[2][static_cast<std::size_t>(n2 * (a / (n0 * n1)) + b / (n0 * n1))];
      all(a, b) = table_[static_cast<std::size_t>(12 * ((d0 * rows + d1) * columns + d2) + entry[component])];
    }
  return all;
}

void PeriodicSum::add_remainder(const Charges& sources, std::span<const Vec3> targets, double* u) const {
  const int in = kind_ == PeriodicKernel::Kind::stokeslet ? 3 : 6, n_nodes = box_.n_nodes();
  constexpr int at_a_time = 4096;
  std::vector<double> at[3], q[6];
  for (auto& component : at) component.resize(static_cast<std::size_t>(sources.n));
  std::vector<std::vector<double>> strengths(static_cast<std::size_t>((sources.n + at_a_time - 1) / at_a_time));  // of each block of sources
  each_block(sources.n, at_a_time, [&](int first, int last) {
    for (int k = first; k < last; ++k) {
      const Vec3 s = in_box({sources.x[k], sources.y[k], sources.z[k]});
      for (int c = 0; c < 3; ++c) at[c][static_cast<std::size_t>(k)] = s[c];
    }
    std::vector<double>& own = strengths[static_cast<std::size_t>(first / at_a_time)];
    own.assign(static_cast<std::size_t>(in * n_nodes), 0);
    std::array<double*, 6> at_nodes{};
    for (int c = 0; c < in; ++c) at_nodes[static_cast<std::size_t>(c)] = &own[static_cast<std::size_t>(c * n_nodes)];
    std::vector<Pack> scratch(static_cast<std::size_t>(in * n_nodes));
    spread(in, box_, Charges{sources.n, at[0].data(), at[1].data(), at[2].data(), sources.q}.part(first, last - first), scratch.data(), at_nodes);
  });
  for (int c = 0; c < 6; ++c) {
    q[c].assign(static_cast<std::size_t>(n_nodes), 0);
    for (const std::vector<double>& own : strengths)
      for (int k = 0; c < in && k < n_nodes; ++k) q[c][static_cast<std::size_t>(k)] += own[static_cast<std::size_t>(c * n_nodes + k)];
  }
  std::vector<double> node_u(static_cast<std::size_t>(3 * far_block * ((n_nodes + far_block - 1) / far_block)), 0.);
  apply(q, node_u);
  each_block(targets.size(), std::size_t{far_block}, [&](std::size_t first, std::size_t last) {
    double block[3 * far_block], sums[3 * far_block] = {};
    for (std::size_t l = 0; l < far_block; ++l) {
      const Vec3 s = in_box(targets[std::min(first + l, targets.size() - 1)]);
      for (std::size_t c = 0; c < 3; ++c) block[far_block * c + l] = s[static_cast<Eigen::Index>(c)];
    }
    interpolate(3, box_, node_u.data(), 1, block, sums);
    for (std::size_t l = 0; l < last - first; ++l)
      for (std::size_t c = 0; c < 3; ++c) u[3 * (first + l) + c] += sums[far_block * c + l];
  });
}

}  // namespace tanktread::stokes
