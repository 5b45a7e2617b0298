#include "system/velocity_solver.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <utility>

#include "base/formatted.hpp"
#include "system/dynamics.hpp"
#include "system/solids/bodies/body_preconditioner.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the parameters with the space and the block of rows of every particle filled in, and with the trivial symmetry if none is set.
CapsuleParameters completed(CapsuleParameters parameters, const spline::Space& space) {
  if (parameters.particles.size() == 1) parameters.particles.front().space = &space;
  set_blocks(parameters.particles);
  if (parameters.symmetry.fundamental().empty()) parameters.symmetry = surface::Symmetry(space.n_points);
  return parameters;
}

/// Returns the motion of control points along interfaces; null if no control points slide.
std::unique_ptr<InterfaceMotion> interface_motion(const spline::Space& space, const CapsuleParameters& parameters, const RowShare& layout,
                                                  const Targets& targets, const Membranes& membranes) {
  if (std::ranges::none_of(parameters.particles, &Particle::slides)) return {};
  return std::make_unique<InterfaceMotion>(space, membranes.unstressed(), parameters, layout, targets, membranes.mass());
}

}  // namespace

VelocitySolver::VelocitySolver(const spline::Space& space, const Net& unstressed, const Net& resting, const stokes::AmbientFlow& flow,
                               const CapsuleParameters& parameters, Phases& phases, std::unique_ptr<Tube> tube)
    : space_(space), resting_(resting), flow_(flow), parameters_(completed(parameters, space)), phases_(phases),
      layout_(space, parameters_.symmetry, phases),
      targets_(space, unstressed, parameters_, layout_),
      membranes_(space, unstressed, parameters_, layout_, phases),
      volumes_(space, resting, particles(), layout_, phases),
      layers_(space, unstressed, parameters_, layout_, targets_, phases),
      tube_(std::move(tube)),
      solids_(parameters_.solids ? std::make_unique<SolidResponse>(*parameters_.solids, space_, membranes_.unstressed(), particles(), flow_)
                                 : nullptr),
      walls_{tube_.get(), solids_.get()},
      solving_{Krylov(parameters_.solvers.of(parameters_.solvers.velocity)), {}, {},
               UserEquations(parameters_.equations, {particles(), resting_, parameters_.viscosity})},
      bodies_{RigidParticles(particles(), resting, parameters_.viscosity, parameters_.quadrature), {}, {}},
      interface_(interface_motion(space, parameters_, layout_, targets_, membranes_)) {
  assert(!tube_ || !targets_.projection());  // Tube computes its response only at collocation sites, not at the sites of a projection
  if (tube_) tube_->set_particles(membranes_.unstressed(), particles());
  if (std::ranges::any_of(particles(), &Particle::by_traction))
    bodies_.tractions = std::make_unique<RigidTractions>(space, membranes_.unstressed(), resting, parameters_, walls_, layout_.points(),
                                                         layout_.ranks());
  if (parameters_.cell || tube_) deform_cell(0);
}

VelocitySolver::~VelocitySolver() = default;

bool VelocitySolver::set_time(double time, double start) {
  const bool other_flow = flow_.set_time(time, start), other_cell = parameters_.cell && deform_cell(time);
  return other_flow || other_cell;
}

bool VelocitySolver::set_forces(Net Forces::* of, Net work) {
  if (same(work, forces_.*of)) return false;
  forces_.*of = std::move(work);
  return true;
}

/// Solves (4.2) at a shape, with each particle replaced by its image in the cell of a lattice, and converts the velocities of the images to
/// velocities of the particles. `guess`: see solve(). `error`: see SolvedShape.
SolvedShape VelocitySolver::solve(const Net& shape, const Net& guess, double error) {
  SolvedShape found{.error = error, .velocity = not_a_number(shape)};
  if (!solving_.added.empty()) found.solution = not_a_number(BlockVector(unknowns(keeps_multipliers())));
  if (!shape.allFinite()) return found;
  Net x = shape, v = guess;
  const auto [shifts, origin] = move_into_cell(x, &v);
  bodies_.rigid.move_into_cell(shifts);
  bodies_.rigid.fit_to(x);
  walls_.set_shape(x, targets_, origin);
  v = solve_in_cell(x, shifts, v, found);
  for (std::size_t p = 0; p < shifts.size(); ++p)
    for (Net* net : {&v, &found.fluid})
      if (net->size() > 0) particles()[p].block.rows(*net).rowwise() += shifts[p].velocity.transpose();
  bodies_.rigid.move_out_of_cell(shifts);
  found.velocity = symmetric(v);
  if (!bodies_.rigid.empty()) found.rigid = bodies_.rigid;
  return found;
}

WorkOfLoads VelocitySolver::work_of_loads(const Net& x) {
  WorkOfLoads found;
  found.work = membranes_.work(x, found.sums);
  for (const Net* of_forces : forces_.all())
    if (of_forces->size() > 0) found.work -= *of_forces;
  clear_rigid(particles(), found.work);  // rows of rigid bodies are 0; push_bodies() applies the forces on rigid bodies instead
  return found;
}

/// Sets the contact forces on rigid bodies and the forces of their loads (Particle::loads), in addition to the prescribed forces on the bodies.
/// `work`: virtual work (Sources::work) of further loads, if it has rows.
void VelocitySolver::push_bodies(const Net& x, const Net& work) {
  if (bodies_.rigid.empty()) return;
  Net push = forces_.contacts;  // there are no fields on rigid bodies
  if (work.size() > 0) push = push.size() > 0 ? Net(push - work) : Net(-work);
  if (std::ranges::any_of(particles(), [](const Particle& one) { return one.rigid && !one.loads.empty(); })) {
    Net of_loads = Net::Zero(x.rows(), 3);
    membranes_.complete_work(x, of_loads);
    push = push.size() > 0 ? Net(push - of_loads) : Net(-of_loads);
  }
  bodies_.rigid.push(push);
}

/// Returns membrane_load(x, known). Sets `volume`, unless it is null, to the volume projection at x; leaves it inactive if the volumes are free.
Net VelocitySolver::load_and_projection(const Net& x, WorkOfLoads& known, VolumeProjection* volume) {
  Net* direction = nullptr;  // field c of the projection: b = dV/dx, until M0^-1 is applied to it together with the load
  if (volume && parameters_.volume.constrained()) {
    const Net gradient = volumes_.gradient(x);
    *volume = volumes_.projection(gradient, gradient);
    direction = &volume->direction;
  }
  const auto clock = phases_.time("membrane");
  if (parameters_.strong_load) {
    if (has_forces()) throw std::logic_error("the strong form has no load due to additional forces");
    if (direction) *direction = membranes_.solved(std::move(*direction));
    return targets_.collocated(membranes_.strong_load(x));
  }
  if (known.work.size() == 0) known = work_of_loads(x);
  return membranes_.load(x, known.work, direction);
}

/// Computes (4.2) in the cell. All walls and the rigid bodies must be set to the shape x. Returns the velocity of the control points, and sets the
/// other quantities of `found`, whose allowed error is given.
Net VelocitySolver::solve_in_cell(const Net& x, std::span<const CellShift> shifts, const Net& guess, SolvedShape& found) {
  if (!in_fluid(x)) return not_a_number(x);
  push_bodies(x);
  const std::shared_ptr<AtShape> at = at_shape(x, found.virtual_work, keeps_multipliers(), shifts);
  const Net fluid = bodies_.tractions ? solve_tractions(at, found) : solve_second_kind(*at, guess, found);
  if (!interface_) return fluid;
  found.fluid = symmetric(fluid);
  const auto clock = phases_.time("interface motion");
  Net v = interface_->velocity(x, at->volume.active() ? at->volume.gradient : volumes_.gradient(x), fluid, found.slip);
  at->volume.apply(v);  // removes the small change of volume that the spline interpolation of the normal velocity causes
  return v;
}

/// Solves the system at a shape. The unknowns of rigid bodies are the densities w of (2.23), which are replaced by the velocities of the bodies at
/// the end. Returns the fluid velocity, and sets loads, unknowns and the response of a tube in `found`.
Net VelocitySolver::solve_second_kind(AtShape& at, const Net& guess, SolvedShape& found) {
  RigidParticles& rigid = bodies_.rigid;
  Sources known;
  BlockVector y = at.system->right_hand_side(&known);
  if (has_velocity_system()) y = solve_velocity(at, y, interface_ ? Net() : guess, found.error);
  else if (tube_) found.response = std::move(known.walls->tube);  // no load depends on the unknowns
  Net v = System::particles(y);
  at.volume.apply(v);
  found.unknowns = v;
  if (is_explicit() && solving_.added.empty()) {
    found.load = std::move(known.load);
  } else {
    System::particles(y) = symmetric(v);
    set_load(at, y, found);
  }
  if (rigid.empty()) return v;
  found.unknowns = symmetric(v);
  rigid.store_density(v);
  return v;
}

/// Returns whether all collocation sites are in the medium, inside the tube, in front of plates and outside posts, if there are any. Sets crossing().
/// Collective.
bool VelocitySolver::in_fluid(const Net& x) {
  const Net at_sites = targets_.at_sites() * x;
  FluidWalls::Crossing found = walls_.crossing(at_sites, layout_);
  if (found.site < 0) found = {stokes::first_outside(parameters_.medium.get(), at_sites), "the wall"};
  const auto crosses = [&](const Particle& one) { return one.block.contains(static_cast<int>(found.site)); };
  crossing_.clear();
  if (found.site >= 0) {
    const auto row = at_sites.row(found.site);
    crossing_ = std::ranges::find_if(particles(), crosses)->path + " would cross " + found.solid +
                formatted(" near [%.4g, %.4g, %.4g]", row[0], row[1], row[2]);
  }
  if (walls_.tube) crossing_ = layout_.text_of_any(crossing_);
  return crossing_.empty();
}

Net VelocitySolver::defect(const Net& shape, const Net& given) {
  assert(unknowns_are_velocities() && eliminates_walls());
  Net u = given;
  const Net x = place(shape, &u);
  if (!in_fluid(x)) return not_a_number(x);
  WorkOfLoads work;
  const std::shared_ptr<AtShape> at = at_shape(x, work, false);
  return symmetric(-System::particles(at->system->residual(at->system->of(u), Given::included)));
}

stokes::Evaluations VelocitySolver::kernel_evaluations() const {
  const RigidTractions* const bodies = bodies_.tractions.get();
  return layers_.evaluations() + (bodies ? bodies->kernel_evaluations() : walls_.evaluations());  // bodies->kernel_evaluations() includes the walls
}

/// Sets the cell as deformed by the flow until `time` (2.51). Returns whether the cell has changed. The cell of a duct is constant.
bool VelocitySolver::deform_cell(double time) {
  if (tube_) {
    cell_ = tube_->cell();
    return false;
  }
  // A cell with walls or posts is not deformed.
  const Mat3 deformation = walls_.any() ? Mat3(Mat3::Identity()) : flow_.deformation(time);
  const stokes::PeriodicCell now(deformation * parameters_.cell->vectors(), parameters_.cell->n());
  if (cell_ && *cell_ == now) return false;
  cell_ = now;
  layers_.repeat(now);
  if (bodies_.tractions) bodies_.tractions->repeat(now);
  return true;
}

VelocitySolver::CellMove VelocitySolver::move_into_cell(Net& x, Net* v) const {
  CellMove move;
  if (!cell_) return move;
  const Vec3 middle = cell_origin(x);
  if (tube_ && !tube_->properties().fixed) move.origin = middle[0];
  for (const Particle& particle : particles()) {
    auto rows = particle.block.rows(x);
    CellShift& shift = move.shifts.emplace_back(cell_->shift(rows.colwise().mean().transpose() - middle));
    if (!tube_) shift.velocity = flow_.cell_gradient() * shift.position;
    rows.rowwise() -= shift.position.transpose();
    if (v && v->size() > 0) particle.block.rows(*v).rowwise() -= shift.velocity.transpose();
  }
  return move;
}

Net VelocitySolver::place(Net x, Net* v) {
  const std::optional<double> origin = move_into_cell(x, v).origin;
  // Fits a copy of the bodies to x, which changes x as in solve(). If solve() has set the walls to this shape, set_shape() then has nothing to do.
  if (!bodies_.rigid.empty()) RigidParticles(bodies_.rigid).fit_to(x);
  walls_.set_shape(x, targets_, origin);
  return x;
}

/// Returns the middle of the cell. In a straight tube, whose wall moves with the particles, it is on the x1 axis, at the mean x1 of all control
/// points, even if the particles are far apart.
Vec3 VelocitySolver::cell_origin(const Net& x) const {
  if (!tube_) return Vec3::Zero();
  if (tube_->properties().fixed) return (tube_->wall().start + tube_->wall().end) / 2 * Vec3::UnitX();
  return x.col(0).mean() * Vec3::UnitX();
}

}  // namespace tanktread::coupling
