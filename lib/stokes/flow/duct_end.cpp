#include "stokes/flow/duct_end.hpp"

#include <cmath>
#include <utility>

#include "base/errors.hpp"
#include "quadrature/gauss.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/kernels/kernels.hpp"
#include "stokes/sums/far_sums.hpp"

namespace tanktread::stokes {
namespace {

using surface::Vec2;

constexpr int far_around = 24, order_far = 5, order_close = 7;
constexpr double far = 1.2, smallest = 1e-5;  // far: distance from the plane of the end beyond which the fixed nodes far_ are accurate enough.
                                              // divided by the largest distance of the outline from its centroid. smallest: size below which a
                                              // cell is not divided, divided by the radius of the duct

Mat3 axes(const surface::Channel::Section& place) {
  Mat3 axes;
  axes << place.along, place.normal, Vec3::UnitZ();
  return axes;
}

}  // namespace

DuctEnd::DuctEnd(DuctFlow flow, const surface::Channel::Section& place, int inward) : flow_(std::move(flow)), place_(place), inward_(inward) {
  for (const Cell& cell : cells(4 * far_around)) {
    const surface::PlaneJet at = flow_.outline().at(cell.side, cell.t[0]);
    const Vec2 arm = at.x - flow_.outline().centroid();
    if (arm[0] * at.d[1] - arm[1] * at.d[0] <= 0)
      throw UserError("Channel/outline must be star-shaped about its centroid: each of its points must be visible from there.");
    arm_ = std::max(arm_, arm.norm());
  }
  Nodes nodes;
  cells_ = cells(far_around);
  for (const Cell& cell : cells_) {
    add(cell, order_far, nodes);
    Nodes own;
    add(cell, order_close, own);
    close_.push_back(sources(own));
  }
  far_ = sources(nodes);
}

std::vector<DuctEnd::Cell> DuctEnd::cells(int around) const {
  std::vector<Cell> cells;
  const auto share = flow_.outline().shares(around);
  for (int k = 0; k < flow_.outline().n_sides(); ++k) {
    const std::vector<double> u = flow_.outline().knots(k, share[static_cast<std::size_t>(k)]);
    for (std::size_t i = 0; i + 1 < u.size(); ++i) cells.push_back({k, {u[i], u[i + 1]}, {0, 1}});
  }
  return cells;
}

Vec2 DuctEnd::ray(const Cell& cell, double t, double r) const {
  const Vec2 centre = flow_.outline().centroid();
  return centre + r * (flow_.outline().point(cell.side, t) - centre);
}

void DuctEnd::add(const Cell& cell, int order, Nodes& nodes) const {
  const quadrature::GaussRule& rule = quadrature::gauss(order);
  const Vec2 centre = flow_.outline().centroid();
  const double dt = cell.t[1] - cell.t[0], dr = cell.r[1] - cell.r[0];
  for (int i = 0; i < order; ++i) {
    const surface::PlaneJet at = flow_.outline().at(cell.side, cell.t[0] + rule.nodes[i] * dt);
    const Vec2 arm = at.x - centre;
    const double swept = arm[0] * at.d[1] - arm[1] * at.d[0];
    for (int j = 0; j < order; ++j) {
      const double r = cell.r[0] + rule.nodes[j] * dr;
      for (int c = 0; c < 2; ++c) nodes.y[c].push_back(centre[c] + r * arm[c]);
      nodes.area.push_back(rule.weights[i] * rule.weights[j] * dt * dr * r * swept);
    }
  }
}

/// Returns true if a point is closer to a cell than the size of the cell. Sets `around` to true if the cell is longer around the centroid of the
/// cross-section than along the rays from the centroid. `at`: height of the point above the plane of the end, then its two coordinates in this plane.
bool DuctEnd::close(const Cell& cell, const Vec3& at, bool& around) const {
  const Vec2 a = ray(cell, cell.t[0], cell.r[0]), b = ray(cell, cell.t[1], cell.r[0]), c = ray(cell, cell.t[0], cell.r[1]),
             d = ray(cell, cell.t[1], cell.r[1]), middle = ray(cell, (cell.t[0] + cell.t[1]) / 2, (cell.r[0] + cell.r[1]) / 2);
  const double wide = (d - c).norm(), outward = (c - a).norm(), size = std::max(wide, outward);
  const double reach = std::max({(a - middle).norm(), (b - middle).norm(), (c - middle).norm(), (d - middle).norm()});
  around = wide > outward;
  return std::hypot(at[0], std::max(0., (at.tail<2>() - middle).norm() - reach)) <= size && size > smallest * flow_.radius();
}

void DuctEnd::add_graded(const Cell& cell, const Vec3& at, Nodes& nodes) const {
  bool around = false;
  if (!close(cell, at, around)) return add(cell, order_close, nodes);
  for (const int k : {0, 1}) {
    Cell half = cell;
    double(&range)[2] = around ? half.t : half.r;
    range[1 - k] = (range[0] + range[1]) / 2;
    add_graded(half, at, nodes);
  }
}

DuctEnd::Sources DuctEnd::sources(const Nodes& nodes) const {
  const auto n = static_cast<Eigen::Index>(nodes.area.size());
  Net section = Net::Zero(n, 3);
  for (Eigen::Index k = 0; k < n; ++k)
    for (int c = 0; c < 2; ++c) section(k, c + 1) = nodes.y[c][static_cast<std::size_t>(k)];
  const Net u = flow_.velocities(section);
  const std::vector<Mat3> slope = flow_.gradients(section);
  const Mat3 turn = axes(place_);
  Sources all;
  for (auto* values : {&all.x, &all.force, &all.velocity, &all.normal})
    for (std::vector<double>& component : *values) component.resize(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
    const double weight = over_8_pi * nodes.area[k];
    const Vec3 x = place_.centre + turn * section.row(static_cast<Eigen::Index>(k)).transpose();
    const Vec3 force = turn * (-inward_ * weight * Vec3(0, slope[k](0, 1), slope[k](0, 2)));
    for (int c = 0; c < 3; ++c) {
      all.x[c][k] = x[c], all.force[c][k] = force[c];
      all.velocity[c][k] = u(static_cast<Eigen::Index>(k), 0) * place_.along[c];
      all.normal[c][k] = inward_ * weight * place_.along[c];
    }
  }
  return all;
}

void DuctEnd::add(const Sources& s, const Vec3& target, Eigen::Ref<Eigen::Matrix<double, 1, 3>> u) {
  double by_forces[3], by_stresslets[3];
  const double none[3] = {};
  node_sum(charges(s.x, s.force), target.data(), by_forces);
  node_sum(stresslets(s.x, s.velocity, s.normal), target.data(), none, by_stresslets);
  for (int c = 0; c < 3; ++c) u[c] += by_forces[c] + by_stresslets[c];
}

Net DuctEnd::velocities(const Net& x) const {
  const Mat3 turn = axes(place_);
  Net u = Net::Zero(x.rows(), 3);
  std::vector<Vec3> at;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Vec3 target = x.row(i).transpose(), local = turn.transpose() * (target - place_.centre);
    if (std::abs(local[0]) > far * arm_) {
      at.push_back(target), rows.push_back(i);
      continue;
    }
    Nodes nodes;
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      bool around = false;
      if (close(cells_[k], local, around))
        add_graded(cells_[k], local, nodes);
      else
        add(close_[k], target, u.row(i));
    }
    if (!nodes.area.empty()) add(sources(nodes), target, u.row(i));
  }
  std::vector<double> one(3 * at.size()), other(3 * at.size());
  const std::vector<Vec3> none(at.size(), Vec3::Zero());
  far_sums(charges(far_.x, far_.force), at, one.data());
  far_sums(stresslets(far_.x, far_.velocity, far_.normal), at, none, other.data());
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) u(rows[k], static_cast<Eigen::Index>(c)) = one[3 * k + c] + other[3 * k + c];
  return u;
}

DuctEnd::Points DuctEnd::points() const {
  Nodes nodes;
  for (const Cell& cell : cells_)  // places as many points on the outer quarter of each ray as on its inner three quarters, because the collocation
                                   // error on the wall affects the flow up to about one wall element away
    for (const auto& [inner, outer] : {std::pair(0., 0.75), std::pair(0.75, 1.)})
      add({cell.side, {cell.t[0], cell.t[1]}, {inner, outer}}, order_close, nodes);
  const auto n = static_cast<Eigen::Index>(nodes.area.size());
  Points points{Net(n, 3), Eigen::Map<const Eigen::VectorXd>(nodes.area.data(), n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    points.x.row(k) = (place_.centre + axes(place_) * Vec3(0, nodes.y[0][i], nodes.y[1][i])).transpose();
  }
  return points;
}

}  // namespace tanktread::stokes
