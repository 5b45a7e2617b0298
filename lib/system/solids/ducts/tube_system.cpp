#include "system/solids/ducts/tube_system.hpp"

#include <type_traits>
#include <utility>

namespace tanktread::coupling {

namespace {

/// Access to the blocks of an array of unknowns or residuals: velocity v, wall traction f^D, pressure drop dp and one volume multiplier per particle
/// whose volume is constrained.
template <class Number>
struct Parts {
  using Rows = Eigen::Map<std::conditional_t<std::is_const_v<Number>, const Net, Net>>;
  Rows velocity, wall_traction;
  Number &pressure_drop, *multipliers;

  Parts(const TubeSystem& system, Number* numbers)
      : Parts(numbers, system.tube.inlet_on_particle().rows(), static_cast<Eigen::Index>(system.tube.wall().sites.size())) {}
  Parts(Number* numbers, Eigen::Index particle, Eigen::Index wall)
      : velocity(numbers, particle, 3),
        wall_traction(numbers + 3 * particle, wall, 3),
        pressure_drop(numbers[3 * (particle + wall)]),
        multipliers(numbers + 3 * (particle + wall) + 1) {}
};
using In = Parts<const double>;
using Out = Parts<double>;

/// Returns b.v / (b.n) of one particle (2.8).
double flux_of(const TubeSystem& s, const spline::Block& block, const Net& v) {
  const auto product = [&](const Net& field) { return dot(block.rows(s.volume.gradient), block.rows(field)); };
  return product(v) / product(s.volume.direction);
}

/// Adds `factor` times the normal field n = M0^-1 b on one particle to v.
void add_normal(const TubeSystem& s, const spline::Block& block, double factor, Eigen::Map<Net>& v) {
  v.middleRows(block.first_point, block.n_points) += factor * block.rows(s.volume.direction);
}

/// Computes the product of the block matrix (2.5) to (2.8) with x.
void product(const TubeSystem& s, const In& x, Out r) {
  Tube& tube = s.tube;
  const Net v = x.velocity, traction = x.wall_traction / s.unit;
  const double drop = x.pressure_drop / s.unit;
  const Net load = s.load(v);
  Net answer = tube.wall_on_particle(traction) + drop * tube.inlet_on_particle();
  if (tube.cell()) answer += tube.images_on_particle(load, v);
  r.velocity = s.unbounded(v, load) - s.control_values(answer);
  r.wall_traction = tube.wall_on_wall(traction) - drop * tube.inlet_on_wall() - tube.particle_on_wall(load, v);
  r.pressure_drop = x.pressure_drop - s.unit * tube.pressure_of(load, v);
  for (std::size_t k = 0; k < s.volume.blocks.size(); ++k) {
    const spline::Block& block = s.volume.blocks[k];
    add_normal(s, block, x.multipliers[k], r.velocity);
    r.multipliers[k] = flux_of(s, block, v);
  }
}

/// Applies the preconditioner, in which the identity replaces the operator B of (2.5). Solves for the velocity and the multipliers, then for the
/// pressure drop, then for the wall traction. If `triangular`, the right-hand sides of the pressure drop and the traction include the contributions
/// of the unknowns that have been computed already.
void precondition(const TubeSystem& s, const In& r, Out x, bool triangular) {
  x.velocity = r.velocity;
  for (std::size_t k = 0; k < s.volume.blocks.size(); ++k) {
    const spline::Block& block = s.volume.blocks[k];
    x.multipliers[k] = flux_of(s, block, r.velocity) - r.multipliers[k];
    add_normal(s, block, -x.multipliers[k], x.velocity);
  }
  x.pressure_drop = r.pressure_drop;
  Net on_wall = r.wall_traction;
  if (triangular) {
    const Net v = x.velocity;
    x.pressure_drop += s.unit * s.tube.pressure_of({}, v);
    on_wall += x.pressure_drop / s.unit * s.tube.inlet_on_wall() + s.tube.particle_on_wall({}, v);
  }
  x.wall_traction = s.unit * s.tube.solve_wall(on_wall);
}

}  // namespace

LinearSystem TubeSystem::linear_system(Blocks velocity, const std::string& preconditioner) const {
  LinearSystem system{std::move(velocity), {}, {}};
  system.blocks.push_back({"wall traction", 3 * static_cast<int>(tube.wall().sites.size())});
  system.blocks.push_back({"pressure drop", 1});
  if (!volume.blocks.empty()) system.blocks.push_back({"multipliers of the volumes", static_cast<int>(volume.blocks.size())});
  system.product = [this](const double* in, double* out) { product(*this, In(*this, in), Out(*this, out)); };
  const bool triangular = preconditioner == "block triangular";
  if (triangular || preconditioner == "block diagonal")
    system.precondition = [this, triangular](const double* in, double* out) {
      coupling::precondition(*this, In(*this, in), Out(*this, out), triangular);
    };
  return system;
}

Eigen::VectorXd TubeSystem::right_hand_side(const Net& velocity, const Net& f) const {
  const std::size_t nodes = tube.wall().sites.size() + static_cast<std::size_t>(velocity.rows());
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * nodes + 1 + volume.blocks.size()));
  Out rows(*this, all.data());
  rows.velocity = velocity;
  if (tube.cell()) rows.velocity += control_values(tube.images_on_particle(f));
  rows.wall_traction = tube.particle_on_wall(f);
  rows.pressure_drop = unit * tube.pressure_of(f);
  return all;
}

}  // namespace tanktread::coupling
