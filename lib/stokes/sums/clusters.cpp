#include "stokes/sums/clusters.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace tanktread::stokes {
namespace {

/// A cluster counts as flat if the smallest principal variance of its points divided by the middle one is below this ratio.
constexpr double flat = 0.1;

/// Returns the number of Chebyshev nodes along the longest axis of a box. With more nodes, clusters are usable at smaller distances, but each cluster
/// costs more. The formula was chosen from measurements on deformed spheres at tolerances of 1e-3 to 1e-8.
int longest_order(double tolerance) {
  return std::clamp(static_cast<int>(std::lround(2.8 - 0.72 * std::log10(tolerance))), 3, most_chebyshev);
}

int chebyshev_order(double tolerance, double z) {
  return static_cast<int>(std::ceil(-std::log(tolerance) / std::log(z + std::sqrt(z * z - 1)) - 1e-9));
}

/// Positions are rounded to multiples of 2^-33 to 2^-32 of the extent of all points before they are compared. Otherwise rounding errors would decide
/// which of two mirrored positions comes first. Clusters would then depend on the number of ranks, and sums would change by a part of the tolerance.
constexpr int compared_bits = 33;

/// Two lengths of a cluster count as equal if their ratio is above this value. Otherwise rounding errors would decide along which axis it is split.
constexpr double equal_extents = 1 - 1e-6;

/// Returns the axes rotated as little as possible so that one of them is the normal.
Mat3 turned(const Mat3& axes, const Vec3& normal) {
  int across;
  (axes * normal).cwiseAbs().maxCoeff(&across);
  const int i = (across + 1) % 3, j = (across + 2) % 3;
  Mat3 result;
  result.row(across) = normal.transpose();
  const Vec3 along = axes.row(i).transpose();
  result.row(i) = (along - along.dot(normal) * normal).normalized().transpose();
  result.row(j) = normal.cross(Vec3(result.row(i).transpose())).transpose();
  return result;
}

}  // namespace

bool Cluster::serves(const ChebyshevBox& other, const Vec3& beyond) const {
  const double r[3] = {other.centre[0] + beyond[0] - centre[0], other.centre[1] + beyond[1] - centre[1], other.centre[2] + beyond[2] - centre[2]};
  double square = 0;
  for (int d = 0; d < 3; ++d) {
    const double* a = other.axes[d];
    const double outside = std::max(0., std::abs(r[0] * a[0] + r[1] * a[1] + r[2] * a[2]) - other.half[d]);
    square += outside * outside;
  }
  return square >= reach * reach;
}

void Clusters::set_sources(const std::vector<double> (&x)[3], std::span<const int> starts) {
  const int n_groups = static_cast<int>(starts.size()) - 1;
  groups_.resize(n_groups);
  for (int g = 0; g < n_groups; ++g) {
    groups_[g].number = g;
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (int k = starts[g]; k < starts[g + 1]; ++k) sum += x[c][k];
      groups_[g].centre[c] = sum / (starts[g + 1] - starts[g]);
    }
  }
  double extent = 0;
  for (int c = 0; c < 3 && n_groups > 0; ++c) {
    const auto [low, high] = std::ranges::minmax(groups_, {}, [c](const Group& group) { return group.centre[c]; });
    extent = std::max(extent, high.centre[c] - low.centre[c]);
  }
  step_ = extent > 0 ? std::exp2(std::ceil(std::log2(extent)) - compared_bits) : 1;
  for (Group& group : groups_) group.centre = group.centre.unaryExpr([this](double coordinate) { return rounded(coordinate); });
  clusters_.clear(), order_.clear();
  const auto lower = [](const Group& one, const Group& other) { return std::ranges::lexicographical_compare(one.centre, other.centre); };
  std::ranges::sort(groups_, lower);  // sorted so that clusters do not depend on the order of the groups of points in the input
  split(0, n_groups, Mat3::Identity(), starts);
  for (int c = 0; c < 3; ++c) {
    point_[c].resize(order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) point_[c][k] = x[c][order_[k]];
    node_[c].clear();
  }
  n_blocks_ = 0;
  for (auto cluster = clusters_.rbegin(); cluster != clusters_.rend(); ++cluster) enclose(*cluster);
}

/// Builds the cluster of groups first .. last - 1 and its descendants, and returns its index. `axes`: axes of the parent's box.
int Clusters::split(int first, int last, Mat3 axes, std::span<const int> starts) {
  Vec3 mean = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();
  int n_points = 0;
  for (int g = first; g < last; ++g) {
    mean += groups_[g].centre;
    n_points += starts[groups_[g].number + 1] - starts[groups_[g].number];
  }
  mean /= last - first;
  for (int g = first; g < last; ++g) covariance += (groups_[g].centre - mean) * (groups_[g].centre - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Mat3> principal;
  principal.computeDirect(covariance);
  if (last - first > 3 && principal.eigenvalues()[0] < flat * principal.eigenvalues()[1])
    axes = turned(axes, principal.eigenvectors().col(0).normalized());

  const int number = static_cast<int>(clusters_.size());
  clusters_.emplace_back();
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&clusters_[number].axes[0][0]) = axes;
  const int first_point = static_cast<int>(order_.size());
  const int middle = first + (last - first + quantum_) / 2 / quantum_ * quantum_;
  if (n_points <= leaf_ || middle <= first || middle >= last) {
    for (int g = first; g < last; ++g)
      for (int k = starts[groups_[g].number]; k < starts[groups_[g].number + 1]; ++k) order_.push_back(k);
  } else {
    Vec3 low = Vec3::Constant(INFINITY), high = -low;
    for (int g = first; g < last; ++g) {
      const Vec3 at = axes * groups_[g].centre;
      low = low.cwiseMin(at), high = high.cwiseMax(at);
    }
    const Vec3 length = high - low;
    int longest = 0;
    while (length[longest] < equal_extents * length.maxCoeff()) ++longest;
    for (int g = first; g < last; ++g) groups_[g].along = rounded(axes.row(longest).dot(groups_[g].centre));
    std::nth_element(groups_.begin() + first, groups_.begin() + middle, groups_.begin() + last, [](const Group& a, const Group& b) {
      return a.along < b.along || (a.along == b.along && std::ranges::lexicographical_compare(a.centre, b.centre));
    });
    const int left = split(first, middle, axes, starts), right = split(middle, last, axes, starts);
    clusters_[number].child[0] = left, clusters_[number].child[1] = right;
  }
  clusters_[number].first = first_point, clusters_[number].last = static_cast<int>(order_.size());
  return number;
}

/// Computes the bounding box of a cluster, and the cluster's Chebyshev nodes. The box of a leaf encloses its points. The box of another cluster
/// encloses the Chebyshev nodes of its two children, or the points of a child that has no nodes.
void Clusters::enclose(Cluster& cluster) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  const auto take = [&](const std::vector<double>(&at)[3], int first, int n) {
    for (int d = 0; d < 3; ++d) {
      const double ax = cluster.axes[d][0], ay = cluster.axes[d][1], az = cluster.axes[d][2];
      for (int k = first; k < first + n; ++k) {
        const double s = ax * at[0][k] + ay * at[1][k] + az * at[2][k];
        low[d] = std::min(low[d], s), high[d] = std::max(high[d], s);
      }
    }
  };
  if (cluster.leaf())
    take(point_, cluster.first, cluster.n_points());
  else
    for (const int child : cluster.child) {
      const Cluster& part = clusters_[child];
      part.bare ? take(point_, part.first, part.n_points()) : take(node_, part.first_node, part.n_nodes());
    }
  double longest = 0, square = 0;
  for (int d = 0; d < 3; ++d) {
    cluster.half[d] = (high[d] - low[d]) / 2;
    for (int c = 0; c < 3; ++c) cluster.centre[c] += cluster.axes[d][c] * (low[d] + high[d]) / 2;
    longest = std::max(longest, cluster.half[d]);
    square += cluster.half[d] * cluster.half[d];
  }
  const int most = longest_order(tolerance_);
  const double rho = std::pow(tolerance_, -1. / most);
  cluster.radius = std::sqrt(square);
  cluster.reach = (rho + 1 / rho) / 2 * longest;
  for (int d = 0; d < 3; ++d)
    cluster.order[d] = cluster.half[d] > 1e-12 * longest ? std::clamp(chebyshev_order(tolerance_, cluster.reach / cluster.half[d]), 1, most) : 1;
  const auto quanta = [this](int n) { return (n + quantum_ - 1) / quantum_; };
  cluster.bare = quanta(cluster.n_points()) <= quanta(cluster.n_nodes());
  cluster.first_node = n_nodes(), cluster.first_block = n_blocks_;
  if (cluster.bare) return;
  const int n = cluster.n_nodes(), all = cluster.first_node + n;
  n_blocks_ += (n + far_block - 1) / far_block;
  for (auto& component : node_) component.resize(all);
  chebyshev_nodes(cluster, &node_[0][all - n], &node_[1][all - n], &node_[2][all - n]);
}

}  // namespace tanktread::stokes
