#pragma once
// Fields on the surfaces of the particles of a run, and what they add to rows and snapshots.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "membrane/maxwell_element.hpp"
#include "membrane/surfactant.hpp"
#include "motion/integrator.hpp"
#include "record/files/nodes.hpp"
#include "record/files/snapshot.hpp"
#include "scene/member.hpp"
#include "scene/series/diagnostics.hpp"
#include "stokes/kernels/kernels.hpp"
#include "system/coupled_motion.hpp"

namespace tanktread {

/// Data of a particle's surfactant for one row.
struct SurfactantRow {
  double mass = 0;                   ///< over the initial one
  double smallest = 0, largest = 0;  ///< concentration over the initial one
  void add_columns(Columns& to) const;
};

/// The surfactants and Maxwell elements of all members on their present meshes. Without any, states are control nets and nothing is stored.
class SurfaceFields {
 public:
  /// Members and capsule must outlive this.
  SurfaceFields(const std::vector<Member>& members, coupling::Capsule& capsule);

  bool empty() const { return all_.empty(); }
  coupling::CoupledMotion* motion() { return motion_ ? &*motion_ : nullptr; }
  coupling::Dynamics& dynamics() { return motion_ ? static_cast<coupling::Dynamics&>(*motion_) : capsule_; }
  Net start(const Net& shape) const { return motion_ ? motion_->start(shape) : shape; }
  Net shape(const Net& y) const { return motion_ && y.rows() > 0 ? motion_->shape(y) : y; }
  Net with_shape(const Net& y, const Net& shape) const { return motion_ && y.rows() > 0 ? motion_->with_shape(y, shape) : shape; }

  /// Returns time, slopes and shapes of a state without the coefficients of fields; the state itself if there are none. Valid until the next call.
  const motion::State& of_shape(const motion::State& state);
  /// Puts shapes and slopes of `own`, a copy of of_shape(), back into the state.
  void put_back(const motion::State& own, motion::State& state) const;

  /// Returns the state `old` on the present meshes, where its shapes are those of `own`, with the fields of `before`, which has the meshes of `old`.
  /// Slopes and secants are left out if there are fields. `bodies`: what each particle had before; null if its mesh is the same.
  motion::State transferred(SurfaceFields& before, const motion::State& old, motion::State own, std::span<const Body* const> bodies);

  /// Passes the state to capsule and fields; to the fields only if the capsule was evaluated within `distance` of it.
  void set_state(const Net& y, double distance = 0);

  /// Returns the values of all fields of particle p, at the state set last, to which refinement looks; empty if there are none.
  surface::FieldsAt values_at(std::size_t p) const;

  /// Adds what the fields of particle p contribute to its row, and the columns of its fields and loads, at the state set last; `y` is that state.
  void add_to(std::size_t p, const Net& y, DeformingRow& now, Columns& to) const;
  /// Returns the power of all fields' loads if the material moves by v.
  double power(const Net& v) const;
  /// Adds snapshot fields of fields and loads at the shape x, and corrects the tensions of interfaces with surfactant.
  void add_to(const output::Nodes& nodes, const Net& x, std::vector<output::Field>& fields) const;

 private:
  struct One {
    std::size_t particle;
    std::unique_ptr<membrane::Field> field;
    membrane::Surfactant* surfactant = nullptr;  // the field, if it is one
    const membrane::FieldParts::Chosen* part = nullptr;  // what it is made by, if it is registered
  };

  Net transferred(SurfaceFields& before, const Net& y, const Net& shape, std::span<const Body* const> bodies);
  void add_registered(const output::Nodes& nodes, const Net& x, std::vector<output::Field>& fields) const;

  const std::vector<Member>& members_;
  coupling::Capsule& capsule_;
  std::vector<One> all_;
  std::optional<coupling::CoupledMotion> motion_;
  motion::State shapes_;
};

/// Returns load, traction, displacement, velocity, tensions and mean curvature at the nodes, and for several particles their number. `all`: the body
/// of all members; x, load and velocity (of the fluids, or empty): control values of all. Serial.
std::vector<output::Field> snapshot_fields(std::span<const Member> members, const Body& all, const output::Nodes& nodes, const Net& x,
                                           const Net& load, const Net& velocity);

/// Returns, at each node, the displacement that moves its particle into the cell around the origin.
output::Rows into_cell(std::span<const Member> members, const stokes::PeriodicCell& cell, const output::Nodes& nodes, const Net& x);

}  // namespace tanktread
