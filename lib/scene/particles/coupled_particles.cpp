// Coupled system of particles, deforming or rigid, in the time loop, on meshes that may change.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/indices.hpp"
#include "scene/member.hpp"
#include "scene/particles/adaptation.hpp"
#include "scene/particles/drift.hpp"
#include "scene/particles/gaps.hpp"
#include "scene/particles/limiter.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/particles/rows.hpp"
#include "scene/particles/surroundings.hpp"
#include "scene/series/surface_fields.hpp"
#include "scene/solids.hpp"
#include "scene/tube.hpp"
#include "spline/locate.hpp"
#include "surface/geometry.hpp"
#include "surface/patch.hpp"
#include "surface/shapes.hpp"
#include "surface/transport.hpp"
#include "system/power_balance.hpp"

namespace tanktread {

namespace {

class CoupledParticles : public ParticleSystem {
 public:
  CoupledParticles(const Scene& scene, coupling::Ranks& ranks, Phases& phases)
      : scene_(scene), ranks_(ranks), phases_(phases), members_(checked_members(scene)), solids_(make_solids(scene, phases)) {
    set_up();
    for (std::size_t p = 0; p < members_.size(); ++p) {
      Member& member = members_[p];
      const Body& body = *member.body;
      member.surfactant_mass = fields_->initial_mass(p);
      member.followed = site_ahead(body.nested(), body.rest, member.geometry->measures(body.rest).centroid, body.plane);
      member.place = spline::place(body.nested(), member.followed);
      follow(member);
    }
  }

  coupling::Dynamics& dynamics() override { return fields_->motion(); }
  coupling::Capsule* capsule() const override { return capsule_.get(); }
  coupling::CoupledMotion* coupled_motion() override { return &fields_->motion(); }
  const Body& body() const override { return stacked_ ? *stacked_ : *members_.front().body; }
  coupling::State start() const override { return fields_->motion().start(body().initial); }
  const surface::BezierMap& bezier() const override { return capsule_->geometry().bezier(); }

  Net surface(const coupling::State& x) const override {
    const coupling::BlockId last{members_.size() - 1};
    return as_net(x.numbers().head(x.layout()->first(last) + x(last).size()));
  }

  bool resume(Resumed& resumed) override {
    const bool another_mesh = restore_mesh(resumed.checkpoint, output::stored_shapes(resumed.checkpoint));
    output::require_fit(resumed.totals.phase_angle.size() == members_.size());
    output::read_vectors(resumed.checkpoint, start().layout(), resumed.state);
    motion::refreeze(dynamics(), resumed.state, resumed.state.time);
    for (std::size_t p = 0; p < members_.size(); ++p) members_[p].phase_angle = resumed.totals.phase_angle[p];
    set_contacts(resumed.totals.contacts);
    return another_mesh;
  }

  void move_to(const output::Checkpoint& mesh, const coupling::State& x) override {
    restore_mesh(mesh, surface(x));
    capsule_->counts() = {};
  }

  void store(output::Checkpoint& checkpoint) const override { tanktread::store(members_, checkpoint); }
  bool enforce_gaps(motion::TimeState& state, double step) override {
    if (!scene_.contact.limiter) return true;
    const auto clock = phases_.time("contact");
    capsule_->set_time(state.time, state.time - step);
    const double least = scene_.least_radius();
    Limiter limiter(members_, *capsule_, ranks_, scene_.contact.limit * least, scene_.flow.viscosity * scene_.rate() * least * least,
                    scene_.rate(), [&] { fields_->set_state(state.x); });
    const Net start = surface(state.x);
    const stokes::AmbientFlow& flow = capsule_->flow();
    const Mat3 deformed =
        flow.deformation(state.time) * flow.deformation(state.time - step).inverse();  // deformation of the lattice in the step (2.51)
    coupling::Contacts contacts = contacts_;
    for (coupling::Contact& one : contacts.all) one.beyond = deformed * one.beyond;
    Net x = start;
    const bool first = contacts_.impulse == 0, holds = limiter.hold(x, !state.frozen.empty(), step, contacts);
    if (holds) contacts_ = std::move(contacts);
    else apply_contacts();
    if (holds && x != start) {
      fields_->motion().shape(state.x) = x;
      state.history = {dynamics().velocity(state.x)};
      state.places.clear();
    }
    if (first && contacts_.impulse > 0)
      remarks_.push_back({"limiter", formatted("at time %.4g Contact/limiter begins to act, because the film between two particles is "
                                               "thinner than Contact/limit, %g R_C = %.4g",
                                               state.time, scene_.contact.limit, scene_.contact.limit * least)});
    return holds;
  }

  coupling::Contacts contacts() const override { return contacts_; }
  void set_contacts(const coupling::Contacts& contacts) override { contacts_ = contacts, apply_contacts(); }

  /// Moves the centroid back to its initial position if `Particle/drift` is `held`. Then refines or coarsens the meshes for which an adaptation is
  /// due at this step.
  bool adapt(motion::TimeState& state, RunTotals& totals) override {
    replaced_.clear();
    if (holds_centre_) hold_centre(capsule_->flow(), capsule_->geometry(), members_.front().scene.particle.shape.center, state);
    const auto due = [&](const Member& member) { return member.scene.adaptation.enabled && totals.step % member.scene.adaptation.interval == 0; };
    if (std::ranges::none_of(members_, due)) return false;
    const auto clock = phases_.time("adaptation");
    fields_->set_state(state.x);
    Net x = surface(state.x);
    rigid_before_ = capsule_->rigid_at(x);
    const auto needs_load = [&](const Member& member) { return due(member) && member.scene.adaptation.limits_load(); };
    const Net load = std::ranges::any_of(members_, needs_load) ? capsule_->evaluate_on_demand(x, {}, 0)->load() : Net(Net::Zero(x.rows(), 3));
    std::vector<Net> loads;
    for (const Member& member : members_) loads.push_back(member.own(load));
    const double origin = capsule_->tube() ? capsule_->tube()->frame_origin(x) : 0;  // before any mesh changes
    std::vector<std::function<Net(const Net&)>> moves(members_.size());  // transfer of a net of each particle; empty if its mesh stays
    for (std::size_t p = 0; p < members_.size(); ++p)
      if (due(members_[p])) moves[p] = adapt_mesh(p, loads[p], origin, state, x, totals);
    if (replaced_.empty()) return false;
    const std::unique_ptr<SurfaceFields> fields = std::move(fields_);  // outlives its capsule, see SurfaceFields::transferred
    rebuild(x);
    capsule_->restore_constraints(x);
    if (!x.allFinite()) throw RunFailure("the constraints cannot be restored on the new mesh");
    apply_contacts();
    std::vector<const Body*> bodies(members_.size(), nullptr);
    for (const auto& [p, body] : replaced_) bodies[p] = body.get();
    if (!fields_->empty()) state.history.clear(), state.direction = {}, state.secants = {};  // rates are not transferred
    coupling::State now = fields_->transferred(*fields, std::exchange(state.x, {}), x, bodies);
    motion::each_vector(state, [&](const std::string&, coupling::State& y) {
      if (y.empty()) return;
      Net shape(n_points(), 3);
      for (std::size_t p = 0; p < members_.size(); ++p) {
        const Net before = y(coupling::BlockId{p});
        members_[p].block.rows(shape) = moves[p] ? moves[p](before) : before;
      }
      y = fields_->transferred(*fields, y, shape, bodies);
    });
    state.x = std::move(now);
    motion::refreeze(dynamics(), state, state.time);
    return true;
  }

  void undo_adapt(const coupling::State& x) override {
    if (replaced_.empty()) return;
    for (auto& [p, body] : replaced_) members_[p].body = std::move(body);
    replaced_.clear();
    rebuild(surface(x));
  }

  std::string slackness(const coupling::State& state) const override {
    const Net x = surface(state);
    std::string found;
    double worst = 0.01;  // a smaller part of the membrane does not count, nor does a tension above -0.01 G_s
    for (const Member& member : members_) {
      if (!member.scene.elastic()) continue;
      const Net own = member.own(x);
      const auto n = static_cast<int>(member.body->space.elements.size());
      const membrane::ElementTensions tensions =
          member.membrane->element_tensions(own, indices(n), global_tension(member.scene, *member.body, own));
      const auto sum = [](const std::vector<double>& areas) { return std::accumulate(areas.begin(), areas.end(), 0.); };
      const double area = sum(tensions.area), compressed = sum(tensions.compressed) / area;
      const double bending = member.scene.bending_modulus(), wave_number = std::numbers::pi * std::sqrt(n / area) / 2;
      // Waves of the wave number sqrt(T/(3 B)) grow fastest under the tension -T with the bending modulus B; the mesh resolves half of its largest.
      const double resisted = 3 * bending * wave_number * wave_number / member.scene.modulus();
      if (compressed <= worst || -tensions.smallest <= std::max(0.01, resisted)) continue;
      worst = compressed;
      found = formatted("%.0f %% of the membrane%s is compressed (to %.2g G_s) with %s: set Membrane/pre-inflation%s (0.05, for example) or "
                        "Membrane/bending number%s (0.01), or replace Steady by Time/final time and Time/steady tolerance",
                        100 * compressed, member.name.empty() ? "" : (" of " + member.scene.path()).c_str(), tensions.smallest,
                        bending > 0 ? "too little resistance to bending for its mesh" : "no resistance to bending",
                        member.scene.membrane.pre_inflation > 0 ? " higher" : "", bending > 0 ? " higher" : "");
    }
    return found;
  }

  std::vector<Warning> remarks() override { return std::exchange(remarks_, {}); }
  coupling::OperationCounts counts() const override { return capsule_->counts(); }
  void set_counts(const coupling::OperationCounts& counts) override { capsule_->counts() = counts; }
  void forget() override { capsule_->forget(); }

  std::vector<PhaseAngle> phase_angle() const override {
    std::vector<PhaseAngle> all;
    for (const Member& member : members_) all.push_back(member.phase_angle);
    return all;
  }

  stokes::Evaluations kernel_evaluations() const override { return kernel_evaluations_ + capsule_->kernel_evaluations(); }

  Columns next_row(const motion::TimeState& state, const ProgressRow& progress) override {
    const auto here = evaluated_for_walls(state);
    const Net x = surface(state.x), v = here->fluid_velocity();
    RunRow row{.progress = progress};
    row.progress.time = state.time, row.progress.counts = capsule_->counts();
    ParticleRows rows(members_, *capsule_, *fields_, *here, state, ranks_);
    const std::vector<RecordedParticle> recorded = recorded_particles(members_, x, v);
    const Columns of_particles = rows.columns(row.progress.step.step, recorded);
    row.together = rows.together(), row.together.stresslet += here->stresslet_between_particles();
    for (const coupling::Contact& contact : contacts_.all) row.together.stresslet += stresslet_between(contact, x);
    set_surroundings(scene_, members_, body(), *capsule_, *here, ranks_, row);
    if (scene_.output.power_balance) row.powers = powers(state);
    row.contacts = contacts_;
    Columns columns;
    row.add_columns(scene_, columns);
    for (std::size_t k = 0; k < scene_.equations.size(); ++k) scene_.equations[k].add_columns(here->values_of_added(k), columns);
    add_series(scene_, state.time, recorded, columns);
    finish(columns);
    columns.append(of_particles);
    return columns;
  }

  SurfaceSnapshot snapshot(const motion::TimeState& state) override {
    const bool moves = !state.history.empty();
    const auto here = fields_->evaluate(state.x, moves ? state.history.front() : coupling::State(), 0);
    const Net x = surface(state.x), load = here->load(), velocity = capsule_->slides() || moves ? here->fluid_velocity() : Net();
    return {x, [this, x, load, velocity](const output::Nodes& nodes) {
              std::vector<output::Field> fields = snapshot_fields(members_, body(), nodes, x, load, velocity);
              fields_->add_to_snapshot(nodes, x, fields);
              if (capsule_->cell()) fields.push_back({"into cell", into_cell(members_, *capsule_->cell(), nodes, x)});
              return fields;
            }};
  }

 private:
  /// Returns the number of control points of all particles on their current meshes.
  Eigen::Index n_points() const {
    return std::accumulate(members_.begin(), members_.end(), 0, [](int n, const Member& member) { return n + member.body->space.n_points; });
  }

  /// Evaluates the velocities at the state. Solves the linear system for the velocity again in two cases: if the velocity
  /// of the step is not accurate enough for tractions on walls, and if deformable particles and rigid bodies occur together, because the loads of
  /// the deformable particles then follow from this solution.
  std::shared_ptr<coupling::Evaluation> evaluated_for_walls(const motion::TimeState& state) {
    std::shared_ptr<coupling::Evaluation> here = fields_->evaluate(state.x, state.history.front(), scene_.time.tolerance);
    const auto rigid = [](const Member& member) { return member.scene.particle.rigid(); };
    const bool mixed = std::ranges::any_of(members_, rigid) && !std::ranges::all_of(members_, rigid);
    if (mixed || !scene_.equations.empty() || ((body().wall || solids_) && state.slope_error > accuracy())) here->solve(0.1 * accuracy());
    return here;
  }

  /// Reads the meshes and volumes of the members from the checkpoint. If the meshes or the symmetry of the shape differ from the current ones,
  /// rebuilds the system.
  /// Returns true if a mesh was read. `x`: shapes on these meshes.
  bool restore_mesh(const output::Checkpoint& checkpoint, const Net& x) {
    bool another_mesh = false;
    try {
      another_mesh = restore(checkpoint, members_);
    } catch (const std::out_of_range&) {  // a number or an array is missing
      output::require_fit(false);
    }
    output::require_fit(x.rows() == n_points());
    const bool another_symmetry = !stacked_ && symmetry(members_.front().scene, body(), x).order() != body().symmetry.order();
    if (another_mesh || another_symmetry) rebuild(x);
    for (std::size_t p = 0; p < members_.size(); ++p) capsule_->solver().volumes().keep(members_[p].body->volume, p);
    return another_mesh;
  }

  coupling::Powers powers(const motion::TimeState& state) {
    const auto clock = phases_.time("power balance");
    if (!power_) power_.emplace(*capsule_, ranks_);
    const Net x = surface(state.x), slope = surface(state.history.front());
    coupling::Powers powers = (*power_)(x, slope);
    if (!fields_->empty()) powers.forces += fields_->power(capsule_->evaluate_on_demand(x, slope, 0)->fluid_velocity());
    return powers;
  }

  /// Sets the current contact forces as loads of the system for all later evaluations.
  void apply_contacts() {
    capsule_->set_forces(&coupling::Capsule::Forces::contacts, coupling::work(capsule_->particles(), contacts_, body().space.n_points));
  }

  /// Returns the stresslet of two opposite contact forces that act at the centroids of the two particles. It is needed for the total stresslet,
  /// because the stresslet of each particle is computed about the particle's own centroid.
  Mat3 stresslet_between(const coupling::Contact& contact, const Net& x) const {
    const auto centroid = [&](std::size_t k) {
      const Member& member = members_[contact.particle[k]];
      return surface::measures(member.body->space, member.own(x)).centroid;
    };
    const Vec3 apart = centroid(1) + contact.beyond - centroid(0), force = contact.force * contact.normal;
    return force.dot(apart) / 3 * Mat3::Identity() - (force * apart.transpose() + apart * force.transpose()) / 2;
  }

  /// Builds the coupled system and all other data for the current meshes. Keeps the wall of a tube or channel (SharedOptions::walls).
  void set_up() {
    const std::unique_ptr<Body> before = std::exchange(stacked_, nullptr);
    arrange(members_);
    stacked_ = make_stacked_body(members_);
    if (stacked_ && scene_.tube.present) stacked_->wall = before ? before->wall : make_wall(scene_, *stacked_);
    std::unique_ptr<coupling::Tube> around = make_tube(scene_, body(), phases_);
    power_.reset(), fields_.reset();
    if (!stacked_) members_.front().geometry.reset(), members_.front().membrane.reset();
    capsule_.reset();  // the last owner, so that the old system is deleted before the new one is built
    capsule_ = make_capsule(members_, body(), phases_, std::move(around), solids_);
    fields_ = std::make_unique<SurfaceFields>(members_, *capsule_);
  }

  /// Returns the largest error of the slope (the velocity of the control points) that the tolerance allows.
  double accuracy() const { return scene_.time.tolerance * std::abs(capsule_->flow().amplitude() * scene_.rate()); }

  /// Adapts the mesh of particle p if the indicator requires it. Returns the transfer of nets of the particle to the new mesh; empty if the mesh
  /// stays. `origin`: Tube::frame_origin() of the tube; 0 without a tube. x: shapes of all particles on their current meshes.
  std::function<Net(const Net&)> adapt_mesh(std::size_t p, const Net& load, double origin, const motion::TimeState& state, Net& x,
                                            RunTotals& totals) {
    Member& member = members_[p];
    std::vector<double> widths;
    if (const coupling::Tube* tube = capsule_->tube()) {
      Net in_frame = x;
      in_frame.col(0).array() -= origin;
      widths = films(members_, p, in_frame, tube->cell(), &tube->wall());
    } else if (scene_.has_gaps() || scene_.has_films_around_one()) {
      widths = films(members_, p, x, capsule_->cell());
    }
    const Net own = member.own(x), slope = state.history.empty() ? Net() : Net(state.history.front()(coupling::BlockId{p}));
    const bool per_unstressed_area = load_measure(member.scene) == stokes::Measure::reference;
    Adapted change = adapted(member.scene, *member.body, own, slope, load, per_unstressed_area, widths, fields_->values_at(p));
    std::ranges::move(adaptation_remarks(member, change, state.time), std::back_inserter(remarks_));
    if (!change.body) return {};
    const int more = change.body->space.n_points - member.block.n_points;
    carry_contacts(p, change.body->nested());
    replaced_.emplace_back(p, std::exchange(member.body, std::move(change.body)));
    const Eigen::Index before = member.block.first_point, after = x.rows() - before - own.rows();
    x = (Net(x.rows() + more, 3) << x.topRows(before), change.move(own), x.bottomRows(after)).finished();
    member.block.n_points += more;
    if (rigid_before_ && rigid_before_->is_rigid(p)) fit_again(p, x);
    for (std::size_t after = p + 1; after < members_.size(); ++after) members_[after].block.first_point += more;
    (change.finer ? totals.refinements : totals.coarsenings) += 1;
    return std::move(change.move);
  }

  /// Sets the contact sites of particle p on its new mesh, at the same parametric points.
  void carry_contacts(std::size_t p, const spline::Space& to) {
    if (contacts_.all.empty()) return;
    const spline::Locator locator(to);
    for (coupling::Contact& contact : contacts_.all)
      for (std::size_t k = 0; k < 2; ++k)
        if (contact.particle[k] == p) {
          auto& [element, s, t] = contact.site[k];
          s = std::clamp(s, 0., 1.), t = std::clamp(t, 0., 1.);
          contact.site[k] = locator(spline::place(members_[p].body->nested(), contact.site[k]));
        }
  }

  /// Fits the known shape of a rigid particle again on its new mesh, and moves it to its current position.
  void fit_again(std::size_t p, Net& x) {
    const Member& member = members_[p];
    Body& body = *member.body;
    body.rest = surface::fitted_again(body.space, body.rest, member.scene.particle.shape);
    body.initial = body.unstressed = body.rest;
    const Vec3 centre = surface::measures(body.space, body.rest).centroid;
    member.block.rows(x) =
        ((body.rest.rowwise() - centre.transpose()) * rigid_before_->turn(p).transpose()).rowwise() + rigid_before_->centre(p).transpose();
  }

  /// Rebuilds the coupled system for the current meshes of the members, in the shape x. Counts of work are kept.
  void rebuild(const Net& x) {
    if (!stacked_) members_.front().body->symmetry = symmetry(members_.front().scene, body(), x);
    if (capsule_) counts_ = capsule_->counts(), kernel_evaluations_ = kernel_evaluations();
    set_up();
    capsule_->counts() = counts_;
    for (Member& member : members_) follow(member);
  }

  const Scene& scene_;
  coupling::Ranks& ranks_;
  Phases& phases_;
  std::vector<Member> members_;
  std::optional<coupling::SolidScene> solids_;
  std::unique_ptr<Body> stacked_;  // body with the stacked nets of all particles; null if there is only one particle
  std::shared_ptr<coupling::Capsule> capsule_;  // shared with the only member if there is one particle
  std::unique_ptr<SurfaceFields> fields_;
  std::optional<coupling::PowerBalance> power_;  // constructed at the first use
  coupling::OperationCounts counts_;  // work (solves, iterations) of the systems on earlier meshes
  stokes::Evaluations kernel_evaluations_;  // number of kernel evaluations on earlier meshes
  std::vector<std::pair<std::size_t, std::unique_ptr<Body>>> replaced_;  // particles whose mesh the latest step changed, and their previous bodies
  std::optional<coupling::RigidParticles> rigid_before_;  // positions of rigid particles, stored before their meshes change
  std::vector<Warning> remarks_;
  coupling::Contacts contacts_;  // contacts that hold particles apart
  bool holds_centre_ = members_.size() == 1 && holds_centre(members_.front().scene);
};

}  // namespace

std::unique_ptr<ParticleSystem> make_coupled_particles(const Scene& scene, coupling::Ranks& ranks, Phases& phases) {
  return std::make_unique<CoupledParticles>(scene, ranks, phases);
}

}  // namespace tanktread
