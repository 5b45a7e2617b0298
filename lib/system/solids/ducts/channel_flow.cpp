#include "system/solids/ducts/channel_flow.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/indices.hpp"
#include "surface/geometry.hpp"
#include "surface/symmetry.hpp"
#include "system/solids/shared_walls.hpp"

namespace tanktread::coupling {

namespace {
constexpr Eigen::Index few = 64;    // number of points from which on the ranks share the points; with fewer points, each rank evaluates all of them
constexpr double sharpness = 1e-2;  // tolerance of EmptyChannel::layer divided by the tolerance of all other layers

/// Returns the fully developed flow in the cross-section at the arc length s of the centre line, or at the start of the channel if s is not given.
stokes::DuctFlow developed_flow(const surface::Channel& channel, double viscosity, double mean_velocity, std::optional<double> s = {}) {
  const double at = s.value_or(channel.start());
  const surface::Outline outline = channel.outline(at);
  return {outline, stokes::duct_profile(channel.tube(at), outline), viscosity, mean_velocity};
}
}  // namespace

ChannelFlow::ChannelFlow(const surface::TubeOptions& options, double viscosity, double mean_velocity, const quadrature::Options& quadrature,
                         const WallSolver& solver, std::shared_ptr<SharedWalls> walls)
    : DuctFlow(developed_flow(surface::Channel(options), viscosity, mean_velocity)),
      channel_(std::make_shared<const surface::Channel>(options)),
      surface_(std::make_shared<const surface::TubeWall>(surface::channel_wall(channel_, options.azimuthal_elements))),
      options_(options),
      quadrature_(quadrature),
      solver_(solver),
      walls_(std::move(walls)) {
  if (channel_->repeats()) return;
  ends_.push_back(section(channel_->start(), 1));
  ends_.push_back(section(channel_->end(), -1));
}

/// Returns the cross-section at the position s along the centre line, and the fully developed flow through it with the flow rate of the channel.
/// `inward`: 1 at the inlet, where the direction along the centre line points into the fluid; -1 at the outlet.
stokes::DuctEnd ChannelFlow::section(double s, int inward) const {
  const surface::Channel::Section at = channel_->section(s);
  const double area = channel_->outline().area() * at.factor.prod();
  return {developed_flow(*channel_, viscosity(), flow_rate() / area, s), at, inward};
}

std::shared_ptr<Wall> ChannelFlow::wall(Phases* phases) const {
  if (!wall_) wall_ = shared_wall(walls_.get(), *surface_, quadrature_, phases, surface::Symmetry(), solver_);
  return wall_;
}

std::shared_ptr<Wall> ChannelFlow::use_symmetry(Phases& phases, const surface::Symmetry& particle) const {
  if (wall_ && std::ranges::is_permutation(wall_->symmetry().images(), particle.images(), {}, &surface::Image::signs, &surface::Image::signs))
    return wall_;
  const Net* net[] = {&surface_->net};
  std::vector<surface::Image> images;
  for (const surface::Image& image : particle.images()) images.push_back(surface::image(surface_->space, net, image.signs).value());
  const surface::Symmetry symmetry = images.empty() ? surface::Symmetry() : surface::Symmetry(images, surface_->net);
  wall_ = shared_wall(walls_.get(), *surface_, quadrature_, &phases, symmetry, solver_);
  return wall_;
}

/// Returns the velocity that drives the flow, without the velocity due to the wall traction. In an open channel it is P_I + P_O of (2.30), the
/// contributions of both ends. In a periodic channel it is Poiseuille flow in a circular tube with a unit pressure gradient, for any shape of the
/// cross-section.
Net ChannelFlow::driving_velocity(const Net& x) const {
  if (!channel_->repeats()) return ends_[0].velocities(x) + ends_[1].velocities(x);
  Net v = Net::Zero(x.rows(), 3);
  v.col(0) = (std::pow(outline().radius(), 2) - x.rightCols<2>().rowwise().squaredNorm().array()) / (4 * viscosity());
  return v;
}

EmptyChannel& ChannelFlow::kept() const {
  const std::shared_ptr<Wall> wall = this->wall();
  return wall->empty_channel([&] {
    quadrature::Options options = quadrature_;
    options.tolerance = std::max(1e-10, sharpness * quadrature_.tolerance);
    std::unique_ptr<EmptyChannel> made(
        new EmptyChannel{{stokes::Layer::Kernel::single_layer, wall->surface().space, stokes::Sites(), options}, {}});
    if (wall->cell()) made->layer.repeat(*wall->cell());
    made->layer.set_shape(surface_->net);
    return made.release();
  });
}

/// Returns the flow through this channel. Solves for it only if no other channel with the same wall has.
const EmptyFlow& ChannelFlow::solved() const {
  if (solved_) return *solved_;
  EmptyChannel& channel = kept();
  if (!channel.flow) channel.flow = solution(*wall());
  EmptyFlow scaled = *channel.flow;
  const double factor = viscosity() * flow_rate() / scaled.strength;
  scaled.strength *= factor, scaled.pressure_drop *= factor, scaled.traction *= factor;
  if (channel_->repeats()) scaled.driving *= factor;
  solved_ = std::move(scaled);
  return *solved_;
}

EmptyFlow ChannelFlow::solution(const Wall& wall) const {
  const std::vector<int>& own = wall.points().own_targets();
  Net of_ends(wall.points().targets().rows(), 3);
  of_ends(own, Eigen::all) = driving_velocity(wall.points().targets()(own, Eigen::all));
  const Net without = viscosity() * wall.solve(wall.points().collocated(of_ends)), &with = wall.traction_per_pressure_drop();
  const double middle = (channel_->start() + channel_->end()) / 2;
  const stokes::DuctEnd::Points points = section(middle, 1).points();
  const Vec3 along = channel_->section(middle).along;
  const auto rate = [&](const Net& v) { return points.area.dot(v * along); };
  const double given = rate(velocities(points.x, without, 0, 1)), strength = viscosity() * flow_rate();
  if (channel_->repeats()) {
    const double driving = flow_rate() / given;
    return {strength, driving * wall.surface().period, driving, driving * without};
  }
  const double pressure_drop = (flow_rate() - given) / rate(velocities(points.x, with, 1, 0));
  return {strength, pressure_drop, 1, without + pressure_drop * with};
}

/// Returns the velocity at the points x due to the wall traction and the pressure drop, plus `driving` times driving_velocity(x). If there are many
/// points, ranks share them. The tolerance of the layer is smaller than in Wall, because large pressures at the ends amplify errors of the velocity.
Net ChannelFlow::velocities(const Net& x, const Net& traction, double pressure_drop, double driving) const {
  const std::shared_ptr<Wall> wall = this->wall();
  stokes::Layer& layer = kept().layer;
  const Net density = wall->on_space(traction);
  const auto evaluate = [&](std::span<const int> own, Net& v) {
    const Net at = x(own, Eigen::all);
    layer.apply(density, x, own, v);
    Net rest = Net::Zero(at.rows(), 3);
    if (!wall->cell()) rest = pressure_drop / viscosity() * wall->inlet().integral(at);
    if (driving != 0) rest += driving * driving_velocity(at);
    v(own, Eigen::all) = rest - v(own, Eigen::all) / viscosity();
  };
  if (x.rows() >= few) return wall->points().ranks().divided<Net>(static_cast<int>(x.rows()), 3, evaluate);
  Net v(x.rows(), 3);
  evaluate(indices(x.rows()), v);
  return v;
}

Net ChannelFlow::evaluated(const Net& x) const {
  const EmptyFlow& known = solved();
  return velocities(x, known.traction, known.pressure_drop, known.driving);
}

Net ChannelFlow::velocities(const Net& x) const {
  if (x.rows() < few) return evaluated(x);
  if (!same(latest_at_, x)) latest_ = evaluated(x), latest_at_ = x;
  return latest_;
}

std::vector<Mat3> ChannelFlow::gradients(const Net& x) const {
  const double h = 0.01 * channel_->smallest_radius();
  std::vector<Mat3> all(static_cast<std::size_t>(x.rows()));
  const Net here = velocities(x);
  for (int d = 0; d < 3; ++d) {
    const Eigen::RowVector3d step = h * Eigen::RowVector3d::Unit(d);
    const Net slope = (evaluated(x.rowwise() + step) - here) / h;
    for (Eigen::Index i = 0; i < x.rows(); ++i) all[static_cast<std::size_t>(i)].col(d) = slope.row(i).transpose();
  }
  return all;
}

double ChannelFlow::pressure_drop() const { return solved().pressure_drop; }

double ChannelFlow::extra_pressure_drop() const { return pressure_drop() - pressure_gradient() * (channel_->end() - channel_->start()); }

const Net& ChannelFlow::wall_traction() const { return solved().traction; }

std::vector<double> ChannelFlow::flow_rates_at(const std::vector<double>& s) const {
  std::vector<stokes::DuctEnd::Points> points;
  Eigen::Index n = 0;
  for (const double at : s) points.push_back(section(at, 1).points()), n += points.back().x.rows();
  Net all(n, 3);
  n = 0;
  for (const stokes::DuctEnd::Points& of : points) all.middleRows(n, of.x.rows()) = of.x, n += of.x.rows();
  const Net v = evaluated(all);
  std::vector<double> rates;
  n = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    rates.push_back(points[k].area.dot(v.middleRows(n, points[k].x.rows()) * channel_->section(s[k]).along));
    n += points[k].x.rows();
  }
  return rates;
}

}  // namespace tanktread::coupling
