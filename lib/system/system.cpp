#include "system/system.hpp"

#include <utility>

#include "base/formatted.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the number of control points of all particles. The blocks of the particles are the first ones.
Eigen::Index n_points(const Layout& unknowns) {
  Eigen::Index n = 0;
  for (const Block& block : unknowns.blocks()) n += block.on >= 0 ? block.rows : 0;
  return n;
}

}  // namespace

Eigen::Map<Net> System::particles(BlockVector& x) { return {x.numbers().data(), n_points(*x.layout()), 3}; }
Eigen::Map<const Net> System::particles(const BlockVector& x) { return {x.numbers().data(), n_points(*x.layout()), 3}; }

System::System(std::shared_ptr<const Layout> unknowns, Equations equations, std::shared_ptr<LayersAt> layers,
               std::function<Net(const Net&)> control_values)
    : unknowns_(std::move(unknowns)), equations_(std::move(equations)), layers_(std::move(layers)), control_values_(std::move(control_values)) {}

std::string System::plan() const {
  std::string blocks, equations;
  for (const Block& one : unknowns_->blocks())
    blocks += (blocks.empty() ? "" : ", ") + one.name + formatted(" %d x %d", static_cast<int>(one.rows), one.components);
  for (const auto& one : equations_)
    if (const std::string text = one->plan(); !text.empty()) equations += (equations.empty() ? ": " : "; ") + text;
  return blocks + equations;
}

Sources System::sources(const BlockVector& x, Given given) const {
  Sources all;
  all.ambient = given == Given::included;
  for (const auto& one : equations_) one->add_sources(x, given, all);
  if (all.work.size() > 0 && !all.work.isZero(0))
    for (const auto& one : equations_) one->add_loads_of_work(all);
  if (all.density.isZero(0)) all.density.resize(0, 3);  // so that the right-hand side takes no sum of the double layer
  return all;
}

BlockVector System::residual(const BlockVector& x, Given given, Sources* found) const {
  const BlockVector y = projected(x);
  Sources all = sources(y, given);
  for (const auto& one : equations_) one->answer(y, given, all);
  const SurfaceVelocity u(*layers_, all, control_values_, [&] { return velocity(y, given); });
  BlockVector r(unknowns_);
  for (const auto& one : equations_) one->add_residual(y, all, u, given, r);
  r = projected(std::move(r));
  r += x;
  r -= y;
  if (found) *found = std::move(all);
  return r;
}

BlockVector System::right_hand_side(Sources* found) const {
  BlockVector r = residual(BlockVector(unknowns_), Given::included, found);
  r *= -1;
  return r;
}

BlockVector System::projected(BlockVector x) const {
  for (const auto& one : equations_) one->project(x);
  return x;
}

Net System::load(const BlockVector& x, Net* work) const {
  Sources all = sources(x, Given::included);
  if (work) *work = std::move(all.work);
  return all.load.size() > 0 ? all.load : Net(Net::Zero(particles(x).rows(), 3));
}

Net System::velocity(const BlockVector& x, Given given) const {
  Net v = Net::Zero(particles(x).rows(), 3);
  for (const auto& one : equations_) one->add_velocity(x, given, v);
  return v;
}

BlockVector System::of(const Net& of_particles) const {
  BlockVector x(unknowns_);
  particles(x) = of_particles;
  return x;
}

BlockVector System::precondition(const BlockVector& r) const {
  BlockVector x = r;
  if (of_particles_) of_particles_(particles(r).data(), particles(x).data());
  for (const auto& one : equations_) one->precondition(r, x);
  return x;
}

SolveReport System::solve(const Krylov& krylov, const BlockVector& right, BlockVector& x, double tolerance) const {
  LinearSystem system{unknowns_->blocks(), on_blocks(unknowns_, [this](const BlockVector& v) { return residual(v, Given::omitted); }), {}};
  const bool only_particles = particles(right).size() == right.numbers().size();
  if (of_particles_ || !only_particles)  // otherwise precondition() is the identity, and a scaled one (`recycled`) is better
    system.precondition = on_blocks(unknowns_, [this](const BlockVector& r) { return precondition(r); });
  Eigen::VectorXd found = x.numbers();
  const SolveReport report = krylov.solve(system, right.numbers(), found, tolerance);
  x.numbers() = found;
  return report;
}

}  // namespace tanktread::coupling
