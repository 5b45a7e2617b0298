#include "scene/particles/rows.hpp"

#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "scene/series/series.hpp"
#include "surface/patch.hpp"

namespace tanktread {

ParticleRows::ParticleRows(std::vector<Member>& members, const coupling::Capsule& capsule, const SurfaceFields& fields, coupling::Evaluation& here,
                           const motion::TimeState& state, coupling::Ranks& ranks)
    : members_(members), capsule_(capsule), fields_(fields), here_(here), state_(state), ranks_(ranks), columns_(members.size()) {
  const coupling::RigidParticles bodies = capsule.rigid_at(fields.motion().shape(state.x));
  for (std::size_t p = 0; p < members.size(); ++p) {
    if (members[p].scene.particle.rigid())
      rows_.push_back(std::make_unique<RigidRow>(rigid(p, bodies)));
    else
      rows_.push_back(std::make_unique<DeformingRow>(deforming(p)));
  }
  add_treading(here.fluid_velocity());
}

/// Returns the data of the deforming particle p, without the velocity and the tank-treading, which add_treading() sets. Adds the columns of the
/// particle's surface fields to `columns_`.
DeformingRow ParticleRows::deforming(std::size_t p) {
  const Member& member = members_[p];
  const coupling::BlockId shape{p};
  const Net x = state_.x(shape), slope = state_.history.front()(shape);
  DeformingRow now = deforming_row(member.scene, *member.body, *member.geometry, *member.membrane, x, slope, ranks_);
  now.volume_error = capsule_.volume_error(now.measures.volume, p);
  now.stresslet = here_.stresslet(p);
  now.energy += here_.load_energy(p);
  if (member.scene.viscous_membrane()) now.dissipation = here_.membrane_dissipation(p);
  now.intrinsic_viscosity = intrinsic_viscosity(capsule_.flow(), member.scene.flow.viscosity, now);
  fields_.add_to_row(p, state_.x, now, columns_[p]);
  return now;
}

/// Returns the data of the rigid particle p. `bodies`: the rigid bodies at their positions.
RigidRow ParticleRows::rigid(std::size_t p, const coupling::RigidParticles& bodies) {
  const Member& member = members_[p];
  const coupling::RigidParticles& rigid = here_.rigid();
  RigidRow now = rigid_row(member.scene, *member.body, capsule_.flow(), *member.geometry, member.own(here_.x()), rigid.motion(p),
                           Eigen::Quaterniond(bodies.turn(p)), here_.stresslet(p), ranks_);
  now.drag = -rigid.force(p), now.torque = -rigid.torque(p);
  return now;
}

/// Sets velocity and tank-treading in the rows of the deforming particles, from the fluid velocity v on their surfaces. Each particle is evaluated by
/// one rank.
void ParticleRows::add_treading(const Net& v) {
  const auto found = ranks_.divided<Eigen::MatrixXd>(static_cast<int>(rows_.size()), 5, [&](std::span<const int> mine, Eigen::MatrixXd& to) {
    for (const int k : mine) {
      const Member& member = members_[k];
      if (member.scene.particle.rigid()) continue;
      ParticleRow& now = *rows_[k];
      tanktread::add_treading(member.scene, *member.body, *member.geometry, state_.x(coupling::BlockId{static_cast<std::size_t>(k)}), member.own(v),
                              now);
      to.row(k) << now.velocity.transpose(), now.treading.velocity, now.treading.frequency;
    }
  });
  for (Eigen::Index p = 0; p < found.rows(); ++p)
    if (!members_[p].scene.particle.rigid())
      rows_[p]->velocity = found.row(p).head<3>().transpose(), rows_[p]->treading = {found(p, 3), found(p, 4)};
}

/// The phase angle is the angle of the material point Member::followed about the centroid.
void ParticleRows::advance_phases(double step) {
  for (std::size_t p = 0; p < members_.size(); ++p) {
    Member& member = members_[p];
    if (member.scene.particle.rigid()) continue;
    const Body& body = *member.body;
    ParticleRow& now = *rows_[p];
    std::optional<double> angle;
    if (!capsule_.particles()[p].slides())
      angle = angle_in(body.plane, surface::value(body.nested(), state_.x(coupling::BlockId{p}), member.followed) - now.centre);
    member.phase_angle.advance(step, now.treading.frequency, angle);
    now.phase = member.phase_angle.degrees;
  }
}

Columns ParticleRows::columns(double step, const std::vector<RecordedParticle>& recorded) {
  advance_phases(step);
  Columns all;
  for (std::size_t p = 0; p < members_.size(); ++p) {
    const Member& member = members_[p];
    rows_[p]->add_columns(member.scene, columns_[p]);
    if (!recorded.empty()) add_series(member.scene, state_.time, recorded[p], columns_[p]);
    finish(columns_[p]);
    all.append(columns_[p], member.column({}));
  }
  return all;
}

Together ParticleRows::together() const {
  Together all;
  for (const auto& now : rows_) {
    all.energy += now->energy, all.n_points += now->n_points, all.stresslet += now->stresslet;
    all.velocity += now->velocity / static_cast<double>(rows_.size());
  }
  return all;
}

}  // namespace tanktread
