#include "scene/series/surface_fields.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "membrane/membrane.hpp"
#include "spline/locate.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

Scene with_field_lengths_of(const Scene& first, Scene scene) {
  for (std::size_t p = 0; p < std::min(first.particles.size(), scene.particles.size()); ++p)
    scene.particles[p].field_length = first.particles[p].particle.shape.equivalent_radius();
  return scene;
}

SurfaceFields::SurfaceFields(const std::vector<Member>& members, coupling::Capsule& capsule) : members_(members), capsule_(capsule) {
  for (std::size_t p = 0; p < members.size(); ++p) {
    const ParticleScene& particle_scene = members[p].scene;
    const Body& body = *members[p].body;
    if (particle_scene.surfactant) {
      auto surfactant = std::make_unique<membrane::Surfactant>(body.space, body.rest, *particle_scene.surfactant, body.modulus,
                                                               particle_scene.surfactant->diffusivity_of(particle_scene.flow.rate(), body.radius));
      membrane::Surfactant* const known = surfactant.get();
      all_.push_back({p, std::move(surfactant), known});
    }
    if (particle_scene.maxwell_membrane())
      all_.push_back({p, std::make_unique<membrane::MaxwellElement>(body.space, body.rest, capsule.membrane().order(),
                                                                    particle_scene.membrane.viscosity, *particle_scene.membrane.relaxation_time)});
    for (const auto& part : particle_scene.fields)
      all_.push_back({p, part.make({body.space, body.unstressed, body.rest, body.radius, body.modulus}), nullptr, &part});
  }
  std::vector<coupling::CoupledMotion::FieldOnParticle> on;
  for (const One& one : all_) {
    const std::string name = one.surfactant ? "surfactant" : one.part ? "fields " + one.part->name : "Maxwell strain";
    on.push_back({one.particle, one.field.get(), name, members[one.particle].scene.field_length});
  }
  motion_.emplace(capsule, std::move(on));
}

coupling::State SurfaceFields::transferred(SurfaceFields& before, const coupling::State& y, const Net& shape,
                                           std::span<const Body* const> bodies) {
  before.motion_->set_fields(y);
  coupling::State now = motion_->start(shape);
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const std::size_t p = all_[k].particle;
    const Body* const old = bodies[p];
    if (!old) {
      now.set(motion_->id(k), before.motion_->coefficients(y, k));
      continue;
    }
    const spline::Space &from = old->nested(), &to = members_[p].body->nested();
    const spline::Locator locator(from);
    const auto site = [&](const spline::Site& here) { return locator(spline::place(to, here)); };
    now.set(motion_->id(k), all_[k].field->transferred(*before.all_[k].field, members_[p].own(shape), site));
  }
  return now;
}

void SurfaceFields::set_state(const coupling::State& y, double distance) {
  if (distance > 0 && capsule_.evaluated_about(motion_->shape(y), distance)) motion_->set_fields(y);
  else motion_->set_state(y);
}

std::shared_ptr<coupling::Evaluation> SurfaceFields::evaluate(const coupling::State& y, const coupling::State& rate, double distance) {
  set_state(y, distance);
  return capsule_.evaluate_on_demand(motion_->shape(y), rate.empty() ? Net() : Net(motion().shape(rate)), distance);
}

void SurfactantRow::add_columns(Columns& to) const {
  const auto add = [&](double value, const char* name, const char* description) {
    to.add(value, {name, "1", description, {}, "drop with surfactant"});
  };
  add(mass, "surfactant_mass", "total mass of surfactant divided by its initial value; it stays 1 up to rounding errors");
  add(smallest, "smallest_concentration", "smallest concentration of surfactant on the interface divided by the initial concentration");
  add(largest, "largest_concentration", "largest concentration of surfactant on the interface divided by the initial concentration");
}

surface::FieldsAt SurfaceFields::values_at(std::size_t p) const {
  std::vector<surface::FieldsAt> of;
  for (const One& one : all_)
    if (one.particle == p)
      if (auto values = one.field->values_at()) of.push_back(std::move(values));
  if (of.empty()) return {};
  return [of = std::move(of)](const spline::Site& site) {
    Eigen::VectorXd all;
    for (const surface::FieldsAt& values : of) {
      const Eigen::VectorXd more = values(site);
      all.conservativeResize(all.size() + more.size());
      all.tail(more.size()) = more;
    }
    return all;
  };
}

void SurfaceFields::add_to_row(std::size_t p, const coupling::State& y, DeformingRow& now, Columns& to) const {
  const Member& member = members_[p];
  const Net x = y(coupling::BlockId{p});
  for (std::size_t k = 0; k < member.scene.loads.size(); ++k)
    member.scene.loads[k].add_columns(member.loads.registered[k]->values(x), to);
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const One& one = all_[k];
    if (one.particle != p) continue;
    now.energy += one.field->energy();
    now.dissipation += one.field->dissipation();
    if (one.part) one.part->add_columns(one.field->values(), to);
    if (!one.surfactant) continue;
    const auto [smallest, largest] = one.surfactant->extremes();
    now.tension.smallest = member.scene.surfactant->tension(largest) + global_tension(member.scene, *member.body, x);
    const double mass = one.surfactant->mass(motion_->coefficients(y, k)) / member.surfactant_mass;
    SurfactantRow{mass, smallest, largest}.add_columns(to);
  }
}

double SurfaceFields::initial_mass(std::size_t p) const {
  for (const One& one : all_)
    if (one.particle == p && one.surfactant) return one.surfactant->mass(one.surfactant->start(members_[p].body->initial));
  return 0;
}

double SurfaceFields::power(const Net& v) const {
  double sum = 0;
  for (const One& one : all_) sum += one.field->load().cwiseProduct(members_[one.particle].own(v)).sum();
  return sum;
}

/// Adds the values that registered fields and loads write to snapshots. Each quantity is 0 on particles that do not have it. Throws std::logic_error
/// if a quantity has a wrong shape, or different numbers of columns in two parts.
void SurfaceFields::add_registered(const output::Nodes& nodes, const Net& x, std::vector<output::Field>& fields) const {
  std::map<std::string, Eigen::MatrixXd> all;
  const auto add = [&](std::size_t p, const std::vector<membrane::SurfaceValues>& several) {
    for (const membrane::SurfaceValues& one : several) {
      const spline::Block& block = members_[p].block;
      if (one.values.rows() != block.n_points || (one.values.cols() != 1 && one.values.cols() != 3))
        throw std::logic_error("the quantity " + one.name + " of snapshots must have one row per control point and 1 or 3 columns");
      Eigen::MatrixXd& known = all.try_emplace(one.name, Eigen::MatrixXd::Zero(capsule_.n_points(), one.values.cols())).first->second;
      if (known.cols() != one.values.cols())
        throw std::logic_error("two parts write the quantity " + one.name + " to snapshots with different numbers of columns");
      known.middleRows(block.first_point, block.n_points) = one.values;
    }
  };
  for (const One& one : all_) add(one.particle, one.field->snapshot());
  for (std::size_t p = 0; p < members_.size(); ++p)
    for (const auto& load : capsule_.particles()[p].loads) add(p, load->snapshot(members_[p].own(x)));
  for (const auto& [name, values] : all) {
    Net net = Net::Zero(values.rows(), 3);
    net.leftCols(values.cols()) = values;
    fields.push_back({name, nodes.values(net).leftCols(values.cols())});
  }
}

void SurfaceFields::add_to_snapshot(const output::Nodes& nodes, const Net& x, std::vector<output::Field>& fields) const {
  add_registered(nodes, x, fields);
  Net values = Net::Zero(capsule_.n_points(), 3);
  bool any = false;
  for (const One& one : all_)
    if (one.surfactant) any = true, members_[one.particle].block.rows(values).col(0) = one.surfactant->concentration();
  if (!any) return;
  const Eigen::VectorXd c = nodes.values(values).col(0);
  const std::vector<spline::Site>& sites = nodes.mesh().sites;
  for (const One& one : all_) {
    if (!one.surfactant) continue;
    const Member& member = members_[one.particle];
    const spline::Block& block = member.block;
    const double uniform = global_tension(member.scene, *member.body, member.own(x));
    for (output::Field& field : fields)
      if (field.name == "smallest tension" || field.name == "largest tension")
        for (Eigen::Index i = 0; i < c.size(); ++i)
          if (const int e = sites[static_cast<std::size_t>(i)].element - block.first_element; e >= 0 && e < block.n_elements)
            field.values(i, 0) = member.scene.surfactant->tension(c[i]) + uniform;
  }
  fields.push_back({"concentration", c});
}

namespace {

std::size_t particle_of(std::span<const Member> members, int element) {
  const auto after = std::ranges::upper_bound(members, element, {}, [](const Member& member) { return member.block.first_element; });
  return static_cast<std::size_t>(after - members.begin()) - 1;
}

}  // namespace

std::vector<output::Field> snapshot_fields(std::span<const Member> members, const Body& all, const output::Nodes& nodes, const Net& x,
                                           const Net& load, const Net& velocity) {
  const std::vector<spline::Site>& sites = nodes.mesh().sites;
  const auto n = static_cast<Eigen::Index>(sites.size());
  Net traction = nodes.values(load);
  std::vector<output::Field> fields{{"load", traction}};
  Eigen::MatrixX2d tensions(n, 2);
  Eigen::VectorXd curvature(n), particle(n);
  std::vector<double> uniform;
  for (const Member& member : members) uniform.push_back(global_tension(member.scene, *member.body, member.own(x)));
  nodes.each_node(all.unstressed, x, [&](Eigen::Index i, const surface::Jet& before, const surface::Jet& now) {
    const std::size_t p = particle_of(members, sites[static_cast<std::size_t>(i)].element);
    if (load_measure(members[p].scene) == stokes::Measure::reference) traction.row(i) *= surface::jacobian(before) / surface::jacobian(now);
    if (members[p].scene.particle.rigid())
      tensions.row(i).setZero();
    else
      tensions.row(i) = membrane::tensions(members[p].body->law, std::span(&before, 1), std::span(&now, 1)).array() + uniform[p];
    curvature[i] = surface::mean_curvature(now);
    particle[i] = static_cast<double>(p + 1);
  });
  fields.push_back({"traction", traction});
  fields.push_back({"displacement", nodes.values(x - all.unstressed)});
  if (velocity.size() > 0) fields.push_back({"velocity", nodes.values(velocity)});
  fields.push_back({"smallest tension", tensions.col(0)});
  fields.push_back({"largest tension", tensions.col(1)});
  fields.push_back({"mean curvature", curvature});
  if (members.size() > 1) fields.push_back({"particle", particle});
  return fields;
}

output::Rows into_cell(std::span<const Member> members, const stokes::PeriodicCell& cell, const output::Nodes& nodes, const Net& x) {
  std::vector<Vec3> shifts;
  for (const Member& member : members) shifts.push_back(-cell.shift(member.block.rows(x).colwise().mean().transpose()));
  const std::vector<spline::Site>& sites = nodes.mesh().sites;
  output::Rows rows(static_cast<Eigen::Index>(sites.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = shifts[particle_of(members, sites[static_cast<std::size_t>(i)].element)];
  return rows;
}

}  // namespace tanktread
