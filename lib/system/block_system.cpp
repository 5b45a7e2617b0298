#include "system/block_system.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace tanktread::coupling {

namespace {

/// Numbers of rows of the blocks in the order of the unknowns, in which the multipliers are last. `wall`: -1 if the wall is no unknown.
struct Sizes {
  Eigen::Index particles, wall, multipliers;

  Sizes(const BlockSystem& system, Eigen::Index n_particles)
      : particles(n_particles),
        wall(system.tube ? static_cast<Eigen::Index>(system.tube->wall().sites.size()) : -1),
        multipliers(system.multipliers ? std::ssize(system.volume.blocks) : 0) {}
  Eigen::Index all() const { return 3 * particles + (wall < 0 ? 0 : 3 * wall + 1) + multipliers; }
};

/// Access to the blocks of an array of unknowns or residuals. If the wall is no unknown, the wall traction has no rows, and the pressure drop must
/// not be used.
template <class Number>
struct Parts {
  using Rows = Eigen::Map<std::conditional_t<std::is_const_v<Number>, const Net, Net>>;
  Rows particles, wall_traction;
  Eigen::Map<std::conditional_t<std::is_const_v<Number>, const Eigen::VectorXd, Eigen::VectorXd>> multipliers;
  Number* pressure_drop;

  Parts(const Sizes& sizes, Number* numbers)
      : particles(numbers, sizes.particles, 3),
        wall_traction(numbers + 3 * sizes.particles, std::max<Eigen::Index>(sizes.wall, 0), 3),
        multipliers(numbers + sizes.all() - sizes.multipliers, sizes.multipliers),
        pressure_drop(numbers + 3 * sizes.particles + wall_traction.size()) {}
};
using In = Parts<const double>;
using Out = Parts<double>;

/// Computes the product of the block matrix (2.5) to (2.8) with x.
void product(const BlockSystem& s, const In& x, Out r) {
  Net y = x.particles;
  if (!s.multipliers) s.volume.apply(y);
  const Net load = s.load(y);
  Net rows = s.particles(y, load);
  if (s.tube) {
    Tube& tube = *s.tube;
    const Net traction = x.wall_traction / s.unit;
    const double drop = *x.pressure_drop / s.unit;
    Net answer = tube.wall_on_particle(traction) + drop * tube.inlet_on_particle();
    if (tube.cell()) answer += tube.images_on_particle(load, y);
    rows -= s.control_values(answer);
    r.wall_traction = tube.wall_on_wall(traction) - drop * tube.inlet_on_wall() - tube.particle_on_wall(load, y);
    *r.pressure_drop = *x.pressure_drop - s.unit * tube.pressure_of(load, y);
  }
  if (s.multipliers) s.volume.subtract(-x.multipliers, rows), r.multipliers = s.volume.multipliers(y);
  else s.volume.apply(rows);
  r.particles = rows;
}

/// Applies the preconditioner, see BlockSystem::linear_system.
void precondition(const BlockSystem& s, const In& r, Out x, bool triangular) {
  if (s.of_particles) s.of_particles(r.particles.data(), x.particles.data());
  else x.particles = r.particles;
  if (s.multipliers) {
    Net y = x.particles;
    x.multipliers = s.volume.multipliers(y) - r.multipliers;
    s.volume.subtract(x.multipliers, y);
    x.particles = y;
  }
  if (!s.tube) return;
  *x.pressure_drop = *r.pressure_drop;
  Net on_wall = r.wall_traction;
  if (triangular) {
    const Net y = x.particles;
    *x.pressure_drop += s.unit * s.tube->pressure_of({}, y);
    on_wall += *x.pressure_drop / s.unit * s.tube->inlet_on_wall() + s.tube->particle_on_wall({}, y);
  }
  x.wall_traction = s.unit * s.tube->solve_wall(on_wall);
}

}  // namespace

LinearSystem BlockSystem::linear_system(Blocks names, const std::string& form) const {
  LinearSystem system{std::move(names), {}, {}};
  Eigen::Index components = 0;
  for (const UnknownBlock& block : system.blocks) components += block.size;
  const Sizes sizes(*this, components / 3);
  if (tube) system.blocks.push_back({"wall traction", 3 * sizes.wall}), system.blocks.push_back({"pressure drop", 1});
  if (sizes.multipliers > 0) system.blocks.push_back({"multipliers of the volumes", sizes.multipliers});
  const Eigen::Index named = std::accumulate(system.blocks.begin(), system.blocks.end(), Eigen::Index(0),
                                             [](Eigen::Index sum, const UnknownBlock& block) { return sum + block.size; });
  if (named != sizes.all()) throw std::logic_error("the blocks of a linear system must have as many unknowns as Sizes::all() says");
  system.product = [this, sizes](const double* in, double* out) { coupling::product(*this, In(sizes, in), Out(sizes, out)); };
  const bool has_preconditioner = tube ? form != "block" : of_particles || sizes.multipliers > 0;
  if (has_preconditioner)
    system.precondition = [this, sizes, triangular = form == "block triangular"](const double* in, double* out) {
      coupling::precondition(*this, In(sizes, in), Out(sizes, out), triangular);
    };
  return system;
}

Eigen::VectorXd BlockSystem::right_hand_side(const Net& velocity, const Net& f) const {
  const Sizes sizes(*this, velocity.rows());
  Eigen::VectorXd all = Eigen::VectorXd::Zero(sizes.all());
  Out rows(sizes, all.data());
  Net known = velocity;
  if (tube && tube->cell()) known += control_values(tube->images_on_particle(f));
  if (!multipliers) volume.apply(known);
  rows.particles = known;
  if (!tube) return all;
  rows.wall_traction = tube->particle_on_wall(f);
  *rows.pressure_drop = unit * tube->pressure_of(f);
  return all;
}

}  // namespace tanktread::coupling
