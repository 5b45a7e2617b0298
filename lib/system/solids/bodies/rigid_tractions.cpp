#include "system/solids/bodies/rigid_tractions.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>

#include "system/solids/bodies/rigid_body.hpp"
#include "system/solids/ducts/duct.hpp"

namespace tanktread::coupling {

namespace {

/// Sets six columns to the velocities of a body's unit motions at x, in the rows of the body. If x is a control net, the columns contain control
/// values.
void set_unit_motions(const Net& x, const spline::Block& block, const Vec3& centre, Eigen::Ref<Eigen::MatrixXd> columns) {
  const Net own = block.rows(x);
  for (int k = 0; k < 6; ++k) columns.col(k).segment(3 * block.first_point, 3 * block.n_points) = flat(rigid_velocity(own, unit_motion(k), centre));
}

constexpr int n_unit_strains = 5;

/// Sets five columns to the velocities of the unit strain flows at the sites of a body.
void set_unit_strains(const Net& at, const spline::Block& block, const Vec3& centre, Eigen::Ref<Eigen::MatrixXd> columns) {
  const Net from_centre = block.rows(at).rowwise() - centre.transpose();
  for (int k = 0; k < n_unit_strains; ++k)
    columns.col(k).segment(3 * block.first_point, 3 * block.n_points) = flat(Net(from_centre * unit_strain(k)));
}

/// The sites of a lone body, in a position turned by `turn` from the position of the layer.
class AloneAtSites : public LayersAt {
 public:
  AloneAtSites(BodyLayer& layer, const Mat3& turn) : layer_(layer), turn_(turn) {}
  Net ambient() override { throw std::logic_error("the ambient flow on a lone body is given apart"); }
  Net of_particles(const Net& load, const Net&) override { return layer_.velocity(-load * turn_) * turn_.transpose(); }
  void add_walls(const FluidWalls::Response& walls, Net& u) override { u += walls.tube.velocity; }

 private:
  BodyLayer& layer_;
  Mat3 turn_;
};

std::vector<Particle> bodies_among(std::span<const Particle> particles) {
  std::vector<Particle> bodies;
  std::ranges::copy_if(particles, std::back_inserter(bodies), [](const Particle& one) { return one.rigid.has_value(); });
  return bodies;
}

/// Returns the indices 6 p + k of the unit motions k = 0 .. 5 of all bodies p whose motion is not prescribed, and those of further unknowns up to n.
std::vector<int> free_motions(std::span<const RigidDrive> driven, Eigen::Index n) {
  std::vector<int> free;
  for (std::size_t p = 0; p < driven.size(); ++p)
    for (int k = 0; k < 6; ++k)
      if (!driven[p].prescribed) free.push_back(static_cast<int>(6 * p) + k);
  for (auto k = static_cast<int>(6 * driven.size()); k < n; ++k) free.push_back(k);
  return free;
}

/// Returns the changes of the motions, six per body, that produce the missing forces and torques. Only the motions `free` change. Column k of
/// `resistance`: forces and torques due to unit motion k.
Eigen::VectorXd freed(const std::vector<int>& free, const Eigen::MatrixXd& resistance, const Eigen::VectorXd& missing) {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(missing.size());
  if (free.empty()) return motion;
  const Eigen::MatrixXd part = resistance(free, free);
  const Eigen::VectorXd right = missing(free), solution = part.partialPivLu().solve(right);
  motion(free) = solution;
  return motion;
}

/// Returns the amplitudes of the unit motions: prescribed motions, and the motions that give the prescribed forces and torques. `loads_at_rest`:
/// forces and torques if all bodies are held at rest.
Eigen::VectorXd motions(const std::vector<int>& free, const Eigen::MatrixXd& resistance, const Eigen::VectorXd& loads_at_rest,
                        std::span<const RigidDrive> driven) {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(loads_at_rest.size()), given = motion;
  for (std::size_t p = 0; p < driven.size(); ++p) {
    const RigidDrive& rigid = driven[p];
    const auto first = static_cast<Eigen::Index>(6 * p);
    if (rigid.prescribed)
      motion.segment<6>(first) << rigid.motion.velocity, rigid.motion.angular_velocity;
    else
      given.segment<6>(first) << rigid.force, rigid.torque;
  }
  return motion + freed(free, resistance, given - loads_at_rest - resistance * motion);
}

}  // namespace

CapsuleParameters single_body(const spline::Space& space, double radius, double viscosity, const quadrature::Options& quadrature,
                              const SolverOptions& solvers, std::shared_ptr<const stokes::Medium> medium) {
  CapsuleParameters parameters;
  Particle& body = parameters.particles.front();
  body.space = &space, body.block = spline::whole(space), body.radius = radius;
  body.rigid.emplace(), body.by_traction = true;
  parameters.viscosity = viscosity, parameters.quadrature = quadrature, parameters.medium = std::move(medium);
  parameters.solvers = solvers, parameters.solvers.velocity = solvers.traction;
  return parameters;
}

RigidTractions::RigidTractions(const spline::Space& space, const Net& unstressed, const Net& rest, const CapsuleParameters& parameters,
                               const FluidWalls& walls, const std::vector<int>& own, const Ranks& ranks)
    : particles_(bodies_among(parameters.particles)),
      walls_(walls),
      medium_(parameters.medium),
      layer_(particles_, parameters, own, ranks),
      residual_(space, unstressed, rest, parameters, walls_, ranks),
      collocation_(collocation_matrix(space)),
      mass_(space, 8),  // mass matrix by eight Gauss points per direction, because the area element is not a polynomial
      krylov_(parameters.solvers.of(parameters.solvers.velocity)),
      tolerance_(parameters.solvers.tolerance) {}

void RigidTractions::repeat(const stokes::PeriodicCell& cell) {
  residual_.repeat(cell);
  repeats_ = true;
}

/// Returns all unknowns: y of the particles and those of the added equations, which are zero if `added` is empty.
BlockVector RigidTractions::with_added(const Net& y, const Eigen::VectorXd& added) const {
  BlockVector all = around_->system->of(y);
  all.numbers().tail(added.size()) = added;
  return all;
}

Net RigidTractions::load(const Net& y, const Eigen::VectorXd& added) const {
  return around_ ? around_->system->load(around_->system->projected(with_added(y, added))) : Net(-y);
}

/// Returns the residual of the added equations for the velocity v of the control points and their unknowns.
Eigen::VectorXd RigidTractions::rows_of_added(const Net& v, const Eigen::VectorXd& added, Given given) const {
  BlockVector r(around_->system->unknowns());
  for (const Equation* one : around_->added) one->add_residual(with_added(Net::Zero(v.rows(), 3), added), {}, SurfaceVelocity(v), given, r);
  return r.numbers().tail(n_added());
}

/// Returns the left-hand side of the system for the unknowns y.
Net RigidTractions::product(const Net& y) {
  if (!around_) return caused(load(y));
  const System& system = *around_->system;
  return System::particles(system.residual(system.of(y), Given::omitted));
}

Net RigidTractions::caused(const Net& load, const Mat3& turn) {
  AloneAtSites at(layer_, turn);
  Sources sources{.load = load * turn.transpose()};
  if (walls_.tube) sources.walls = walls_.respond(sources.load, {}, false);
  return velocities(at, sources) * turn;
}

/// Returns the unknowns y, one column per column of `velocities`. In rows of bodies, `velocities` are velocities at the sites; in other rows, they
/// are the right-hand side for the velocity of deformable particles. If responds() is false (A is only the single layer of the bodies), solves only
/// for the force densities and copies the other rows.
Eigen::MatrixXd RigidTractions::densities(const Eigen::MatrixXd& velocities) {
  reports_.clear();
  if (!responds()) return layer_.solved(velocities);
  const Eigen::Index n = velocities.rows();
  const LinearSystem system{one_block("traction", n), on_nets(n / 3, [this](const Net& y) { return product(y); }), layer_.preconditioner()};
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, velocities.cols());
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    if (velocities.col(k).isZero(0)) continue;
    Eigen::VectorXd y = all.col(k);
    reports_.push_back(krylov_.solve(system, velocities.col(k), y, tolerance_));
    all.col(k) = y;
  }
  return all;
}

/// Returns the force densities in the unknowns y, with zero in the rows of deformable particles.
Net RigidTractions::force_densities(const Net& y) const {
  Net f = Net::Zero(y.rows(), 3);
  for (const Particle& body : particles_) body.block.rows(f) = body.block.rows(y);
  return f;
}

/// Returns a vector of unknowns in which number k of the added equations is 1 and all others are 0.
BlockVector RigidTractions::unit_of_added(Eigen::Index k) const { return with_added(Net::Zero(x_.rows(), 3), Eigen::VectorXd::Unit(n_added(), k)); }

/// Adds the rows and columns of the added equations to the matrix of the forces and torques due to unit motions, and their rows to the forces and
/// torques `at_rest`. `fields`: velocity of the bodies' control points in unit motions. `of_all`: unknowns of the unit motions, of the added
/// unknowns and of the flow.
void RigidTractions::add_equations(const Eigen::MatrixXd& fields, const Eigen::MatrixXd& of_all, Eigen::MatrixXd& resistance,
                                   Eigen::VectorXd& at_rest) {
  const Eigen::Index m = resistance.rows(), n = n_added(), of_bodies = m - n;
  const auto velocity = [&](const Eigen::VectorXd& y, const Net& of_body) {
    Net v = all_rigid() ? Net(Net::Zero(x_.rows(), 3)) : completed(y);
    for (const Particle& body : particles_) body.block.rows(v) = body.block.rows(of_body);
    return v;
  };
  for (Eigen::Index k = 0; k < m; ++k) {
    const Eigen::VectorXd added = k < of_bodies ? Eigen::VectorXd::Zero(n).eval() : Eigen::VectorXd::Unit(n, k - of_bodies).eval();
    resistance.col(k).tail(n) = rows_of_added(velocity(of_all.col(k), as_net(fields.col(k))), added, Given::omitted);
    if (k < of_bodies) continue;
    if (const Net work = around_->system->sources(unit_of_added(k - of_bodies), Given::omitted).work; work.size() > 0)
      resistance.col(k).head(of_bodies) += fields.leftCols(of_bodies).transpose() * flat(work);
  }
  const BlockVector none(around_->system->unknowns());
  const Net of_images = around_->system->velocity(none, Given::included);  // on a lattice, from the images in the cell to the particles
  at_rest.tail(n) = rows_of_added(velocity(-of_all.col(m), Net::Zero(x_.rows(), 3)) + of_images, Eigen::VectorXd::Zero(n), Given::included);
}

/// Returns the unknowns y. If responds() is false, rows of deformable particles are completed by the velocity that the force densities cause there.
Net RigidTractions::completed(const Eigen::VectorXd& unknowns) {
  Net y = as_net(unknowns);
  if (responds() || all_rigid()) return y;
  Net minus_velocity = product(force_densities(y));
  for (const Particle& body : particles_) body.block.rows(minus_velocity).setZero();
  return y - minus_velocity;
}

void RigidTractions::set_shape(const Net& x, std::span<const Vec3> centres, std::optional<Surroundings> around) {
  FluidWalls others = walls_;
  others.tube = nullptr;
  if (!around && others.any()) throw std::logic_error("among walls other than a tube, a body needs the surroundings of its traction");
  around_ = std::move(around);
  x_ = x, sites_ = collocation_ * x;
  centres_.assign(centres.begin(), centres.end());
  layer_.set_shape(x, sites_, responds() && !repeats_);
}

/// Returns the collocation-error corrections (2.11) for the unknowns y. Each column of z is a force density; its correction is its work in the
/// residual velocity, computed from Solution::residual. In a channel the residual on the wall is included (2.42).
Eigen::VectorXd RigidTractions::corrections(const Net& y, const Eigen::MatrixXd& z, const Eigen::VectorXd& residual) {
  Eigen::VectorXd work = z.transpose() * residual;
  if (!walls_.tube || !walls_.tube->properties().corrects_walls || !all_rigid()) return work;
  const WallResidual& on_wall = residual_.on_wall(load(y));
  for (Eigen::Index k = 0; k < z.cols(); ++k) work[k] += on_wall.work(walls_.tube->respond(load(as_net(z.col(k)))));
  return work;
}

/// Sets the right-hand sides of unit motions and of units of the added unknowns, and the velocities `fields` of control points in unit motions.
void RigidTractions::set_units(Eigen::Ref<Eigen::MatrixXd> right, Eigen::MatrixXd& fields) {
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto column = static_cast<Eigen::Index>(6 * p);
    set_unit_motions(sites_, particles_[p].block, centres_[p], right.middleCols<6>(column));
    set_unit_motions(x_, particles_[p].block, centres_[p], fields.middleCols<6>(column));
  }
  const Eigen::Index of_bodies = right.cols() - n_added();
  for (Eigen::Index k = 0; k < n_added(); ++k)
    right.col(of_bodies + k) = -flat(Net(System::particles(around_->system->residual(unit_of_added(k), Given::omitted))));
}

const RigidTractions::Solution& RigidTractions::solve(const Net& x, std::span<const Vec3> centres, std::span<const RigidDrive> driven,
                                                      const stokes::AmbientFlow& flow, std::optional<Surroundings> around) {
  set_shape(x, centres, std::move(around));
  const Eigen::Index n = 3 * x.rows(), of_bodies = 6 * static_cast<Eigen::Index>(particles_.size());
  const Eigen::Index m = of_bodies + n_added();  // motions, and the unknowns of added equations, which follow them
  const bool has_pressure = walls_.tube && all_rigid(), driven_by_pressure = flow.duct() && flow.amplitude() != 0;
  const bool apart = has_pressure && !driven_by_pressure;  // true if the density due to the flow of the duct (2.41) needs a separate solve
  // Indices of the columns that follow the columns of the unit motions: ambient flow, and flow of the duct (the same column unless `apart`).
  const Eigen::Index with_flow = m, with_duct = apart ? m + 1 : m;
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(n, with_duct + 1), fields = Eigen::MatrixXd::Zero(n, m);
  // v_inf on bodies, minus the known velocity on other particles; its density is subtracted
  const Net empty = around_ ? Net(-System::particles(around_->system->right_hand_side())) : flow.velocities(sites_);
  set_units(velocities.leftCols(m), fields);
  velocities.col(with_flow) = flat(empty);
  if (apart) velocities.col(with_duct) = flat(walls_.tube->flow().velocities(sites_));
  const Eigen::MatrixXd of_all = densities(velocities), z = of_all.leftCols(m);

  const Eigen::SparseMatrix<double>& mass = mass_.update(x);
  Eigen::MatrixXd work(n, m);  // the inner product of column k with a force density is the work of the density in unit motion k
  for (Eigen::Index k = 0; k < m; ++k) work.col(k) = flat(Net(mass * as_net(fields.col(k))));
  Eigen::MatrixXd resistance = work.transpose() * z;
  Eigen::VectorXd at_rest = -work.transpose() * of_all.col(with_flow);
  if (m > of_bodies) add_equations(fields, of_all, resistance, at_rest);
  const std::vector<int> free = free_motions(driven, m);
  Eigen::VectorXd motion = motions(free, resistance, at_rest, driven);
  Eigen::VectorXd y = z * motion - of_all.col(with_flow);
  Net v = completed(y);
  const Net unknowns = v;
  const Eigen::VectorXd moving = fields * motion;
  for (const Particle& body : particles_) body.block.rows(v) = body.block.rows(as_net(moving));
  const Net between = flow.velocities(residual_.points().values * x);
  solution_ = {};
  solution_.shape = x, solution_.residual = flat(residual_.integrated(x, load(unknowns, motion.tail(m - of_bodies)), v, between));
  Eigen::VectorXd correction = corrections(unknowns, of_all, solution_.residual);
  correction.segment(of_bodies, m - of_bodies).setZero();  // (2.11) is about forces and torques
  const Eigen::VectorXd change = freed(free, resistance, -correction.head(m));
  motion += change;
  y += z * change;
  if (has_pressure) {
    const double unit = apart ? 1 : flow.amplitude();
    const Net f = as_net(y), of_duct = apart ? walls_.tube->flow().velocities(residual_.points().values * x) : Net(between / unit);
    solution_.pressure_correction = residual_.pressure_correction(of_duct, f, correction[with_duct] / unit);
    // If the pressure drop of the duct is prescribed, the error of its flow between the collocation points changes the flow rate, too.
    if (const double slower = walls_.tube->duct().flow_rate_reduction(residual_.ambient_correction(of_duct, f)); slower != 0) {
      const Eigen::VectorXd less = slower / unit * of_all.col(with_duct), slowed = freed(free, resistance, -work.transpose() * less);
      motion += slowed;
      y += z * slowed + less;
    }
  }
  solution_.unknowns = completed(y);
  solution_.added = motion.tail(m - of_bodies);
  const Net f = force_densities(solution_.unknowns);
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const auto first = static_cast<Eigen::Index>(6 * p);
    SolvedBody& body = solution_.bodies.emplace_back(integrals(p, f));
    body.motion = {motion.segment<3>(first), motion.segment<3>(first + 3)};
    body.force += correction.segment<3>(first), body.torque += correction.segment<3>(first + 3);
  }
  return solution_;
}

double RigidTractions::pressure_correction_of(const Net& x, const Net& f, const Net& v, const stokes::AmbientFlow& flow, double slower,
                                              const Net& z) {
  const Net places = residual_.points().values * x, of_duct = walls_.tube->flow().velocities(places);
  const Eigen::VectorXd residual = flat(residual_.integrated(x, load(f), v, flow.velocities(places) - slower * of_duct));
  return residual_.pressure_correction(of_duct, f, corrections(f, flat(z), residual)[0]);
}

Net RigidTractions::density(const Net& velocities) { return as_net(densities(flat(velocities))); }

SolvedBody RigidTractions::integrals(std::size_t p, const Net& f) {
  const spline::Block& block = particles_[p].block;
  const Net weighted = block.rows(Net(mass_.update(x_) * f));
  SolvedBody body;
  body.force = weighted.colwise().sum().transpose();
  body.moment = weighted.transpose() * (block.rows(x_).rowwise() - centres_[p].transpose());
  body.torque = axial_vector(body.moment);
  return body;
}

stokes::Evaluations RigidTractions::kernel_evaluations() const {
  return layer_.evaluations() + residual_.evaluations() + walls_.evaluations();
}

bool RigidTractions::all_rigid() const {
  Eigen::Index points = 0;
  for (const Particle& body : particles_) points += body.block.n_points;
  return points == collocation_.cols();
}

bool RigidTractions::inside(const Net& x) const {
  if (walls_.tube) walls_.tube->set_shape(x);
  return (!walls_.tube || walls_.tube->gap() > 0) && stokes::contains(medium_.get(), collocation_ * x);
}

Mat3 RigidTractions::moment(std::size_t p) {
  if (!same(solution_.shape, x_)) throw std::logic_error("the moment of a body needs the solution at the net that was set last");
  reports_.clear();
  if (walls_.tube) return solution_.bodies[p].moment;
  Eigen::MatrixXd velocities = Eigen::MatrixXd::Zero(solution_.residual.size(), n_unit_strains);
  set_unit_strains(sites_, particles_[p].block, centres_[p], velocities);
  return solution_.bodies[p].moment + strain_of_products(densities(velocities).transpose() * solution_.residual);
}

int RigidTractions::solve_iteratively(const LinearSystem& system, const Eigen::VectorXd& right, Eigen::VectorXd& unknowns) {
  Eigen::VectorXd found = unknowns;
  reports_ = {krylov_.solve(system, right, found, tolerance_)};
  const int iterations = converged_iterations();
  unknowns = std::move(found);
  return iterations;
}

int RigidTractions::converged_iterations() const {
  int sum = 0;
  for (const SolveReport& report : reports_) require_convergence(report, "the traction on the rigid body", tolerance_), sum += report.iterations;
  return sum;
}

}  // namespace tanktread::coupling
