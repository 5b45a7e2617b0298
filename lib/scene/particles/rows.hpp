#pragma once
// The part of a row of the series that belongs to the particles of a coupled system.

#include <vector>

#include "scene/member.hpp"
#include "scene/series/surface_fields.hpp"

namespace tanktread {

/// Measurements on all particles of a coupled system at one state. Calls are collective.
class ParticleRows {
 public:
  /// `here`: evaluation of the shape of `state`, which has its rate as the first of its `history`. References must outlive this object.
  ParticleRows(std::vector<Member>& members, const coupling::Capsule& capsule, const SurfaceFields& fields, coupling::Evaluation& here,
               const motion::TimeState& state, coupling::Ranks& ranks);

  /// Returns the columns of all particles. Advances Member::phase_angle of each deforming particle by `step`, the step that led to the state; to be
  /// called once per state. `recorded`: particles for user-defined series; empty if there are none.
  Columns columns(double step, const std::vector<RecordedParticle>& recorded);

  Together together() const;  ///< returns totals and means of all particles, without the stresslets of pairs in contact

 private:
  void advance_phases(double step);
  DeformingRow deforming(std::size_t p);
  RigidRow rigid(std::size_t p, const coupling::RigidParticles& bodies);
  void add_treading(const Net& v);

  std::vector<Member>& members_;
  const coupling::Capsule& capsule_;
  const SurfaceFields& fields_;
  coupling::Evaluation& here_;
  const motion::TimeState& state_;
  coupling::Ranks& ranks_;
  std::vector<std::unique_ptr<ParticleRow>> rows_;
  std::vector<Columns> columns_;  // columns of the surface fields of each particle
};

}  // namespace tanktread
