#include "system/capsule.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "system/dynamics.hpp"
#include "system/symmetry.hpp"

namespace tanktread::coupling {

Capsule::Capsule(const spline::Space& space, const Net& unstressed, const Net& resting, const stokes::AmbientFlow& flow,
                 const CapsuleParameters& parameters, Phases& phases, std::unique_ptr<Tube> tube)
    : phases_(phases),
      solver_(space, unstressed, resting, flow, parameters, phases, std::move(tube)),
      frozen_(space, solver_.membranes().unstressed(), this->parameters(), solver_.layout(), solver_.targets(), solver_.membranes().mass_matrix(),
              solver_.layers()),
      jacobian_(solver_, frozen_) {}

std::shared_ptr<Evaluation> Capsule::evaluate(const Net& x, const Net& guess, double error) {
  const std::shared_ptr<Evaluation> before = latest_ && same(x, latest_->x()) ? latest_ : nullptr;
  if (before && before->solved(error)) return before;
  ++counts().evaluations;
  latest_.reset();
  const auto e = std::make_shared<Evaluation>(*this, x, solver_.solve(x, before ? before->velocity() : guess, error));
  if (e->velocity().allFinite()) latest_ = e;
  return e;
}

std::shared_ptr<Evaluation> Capsule::evaluate_on_demand(const Net& x, const Net& velocity, double distance) {
  if (!latest_ || !same(x, latest_->x())) return std::make_shared<Evaluation>(*this, x, velocity, evaluated_about(x, distance) ? latest_ : nullptr);
  return latest_;
}

/// Sets the time. The cached evaluation is kept unless the flow or the cell changes.
void Capsule::set_time(double time, double start) {
  if (solver_.set_time(time, start)) latest_.reset();
}

void Capsule::set_forces(Net Forces::* of, Net work) {
  if (solver_.set_forces(of, std::move(work))) latest_.reset();
}

void Capsule::forget() {
  latest_.reset();
  solver_.walls().forget();
}

Net Capsule::response(Evaluation& at, const Net& work) {
  const Net base = at.velocity(), before = solver_.forces().contacts;
  set_forces(&Forces::contacts, before.size() > 0 ? Net(before + work) : work);
  const Net change = velocity(at.x()) - base;
  set_forces(&Forces::contacts, before);
  return change;
}

Net Capsule::defect(const Net& x, const Net& u) {
  ++counts().evaluations;
  return x.allFinite() ? solver_.defect(x, u) : not_a_number(x);
}

bool Capsule::defect_spares_system() const {
  return !solver_.is_explicit() && solver_.unknowns_are_velocities() && solver_.eliminates_walls();
}

void Capsule::freeze(const Net& x) {
  const auto clock = phases_.time("assembly");
  ++counts().assemblies;
  frozen_.assemble(x, solver_.place(x));
  if (tube()) tube()->freeze();
}

void Capsule::linearise(const Net& x) {
  const auto clock = phases_.time("tangent");
  ++counts().tangents;
  const auto e = evaluate_on_demand(x, {}, 0);
  jacobian_.linearise(x, slides() ? e->virtual_work() : Net(), e->load_sums(), e->slip(), e->solution());
  if (!solver_.is_explicit() && has_frozen()) solver_.use_inverse([this](const Net& rhs) { return jacobian_.inverse_product(rhs); });
}

void Capsule::improve_start(Net& y, const Net& before, double shift) {
  const auto clock = phases_.time("tangent");
  jacobian_.improve_start(y, before, shift);
}

Net Capsule::mesh_motion(const Net& delta) {
  InterfaceMotion* const interface = solver_.interface();
  if (!interface || !interface->relaxes()) return {};
  const auto clock = phases_.time("tangent");
  return interface->derivative(Net::Zero(delta.rows(), 3), delta, {});
}

void Capsule::restore_constraints(Net& x) {
  solver_.rigid().fit_to(x);
  if (parameters().volume.constraint == VolumeConservation::exact) {
    const auto clock = phases_.time("volume");
    solver_.volumes().restore(x, [&](const Net& b) { return jacobian_.inflation(solver_.membranes().solved(b)); });
  }
  if (solver_.equations().empty() || !x.allFinite()) return;
  solver_.equations().restore(x);
  solver_.rigid().fit_to(x);
}

/// Returns velocity fields, with the symmetry of the scene, that do not change the shape: rotations of the meshes of drops and of membranes (4.22).
std::vector<Net> Capsule::relabellings(const Net& x) {
  std::vector<int> axes;
  for (int k = 0; k < 3; ++k) {
    const auto keeps = [k](const surface::Image& g) { return surface::Reflection{g.signs}.of_axial(Vec3::Unit(k))[k] > 0; };
    if (std::ranges::all_of(symmetry().images(), keeps)) axes.push_back(k);
  }
  std::vector<Net> all;
  if (slides()) all = solver_.interface()->rotations(x, axes);
  const Net& unstressed = solver_.membranes().unstressed();
  const membrane::SymmetricSolver& collocation = solver_.targets().collocation();
  for (const Particle& one : particles()) {
    if (one.rigid || one.slides() || std::ranges::any_of(one.loads, &membrane::Load::depends_on_labels)) continue;
    for (const int k : axes)
      if (const auto field = label_rotation(membrane().space(), one.block, unstressed, x, k, collocation)) all.push_back(*field);
  }
  return all;
}

double Capsule::distance(const Net& from, const Net& to) const { return norm(Corotation::deformation(particles(), from, to)); }

double Capsule::norm(const Net& displacement) const {
  double largest = 0;
  for (const Particle& particle : particles()) {
    const double norm = particle.block.rows(displacement).norm() / (particle.radius * std::sqrt(static_cast<double>(particle.block.n_points)));
    largest = norm <= largest ? largest : norm;  // keeps NaN
  }
  return largest;
}

bool Capsule::evaluated_about(const Net& x, double distance) const {
  if (!latest_) return false;
  Net moved = x - latest_->x();
  const auto depends_on_x1 = [](const auto& load) { return !load->rigid_conditions().col(0).isZero(0); };
  const auto notices = [&](const Particle& one) { return std::ranges::any_of(one.loads, depends_on_x1); };
  const bool moves_along = tube() && !tube()->properties().fixed && solver_.equations().empty();
  if (moves_along && std::ranges::none_of(particles(), notices)) moved.col(0).array() -= moved.col(0).mean();
  return norm(moved) <= distance;
}

}  // namespace tanktread::coupling
