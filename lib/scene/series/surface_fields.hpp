#pragma once
// Fields on the surfaces of the particles of a run (surfactant, Maxwell strain, user-defined fields), and their contributions to rows and snapshots.

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

/// Data of a particle's surfactant for one row of the results.
struct SurfactantRow {
  double mass = 0;                   ///< mass divided by the initial mass
  double smallest = 0, largest = 0;  ///< smallest and largest concentration, divided by the initial concentration
  void add_columns(Columns& to) const;
};

/// Returns `scene` with the `field_length` of each particle, by which field values are multiplied in a state, set to R_C of this particle in the
/// scene `first`. All states of a branch of steady shapes thus use the same lengths, even if a parameter of the branch changes R_C.
Scene with_field_lengths_of(const Scene& first, Scene scene);

/// Fields on the current meshes of all members (particles), and the motion of the surfaces together with these fields.
class SurfaceFields {
 public:
  /// The objects `members` and `capsule` must outlive this object.
  SurfaceFields(const std::vector<Member>& members, coupling::Capsule& capsule);

  bool empty() const { return all_.empty(); }  ///< true if there are no fields
  coupling::CoupledMotion& motion() { return *motion_; }
  const coupling::CoupledMotion& motion() const { return *motion_; }

  /// Returns the state y transferred to the current meshes. `shape`: shapes of y, which are already on the current meshes. `before`: the fields on
  /// the previous meshes, whose capsule may be deleted already. `bodies`: for each particle, its body with the previous mesh; null if the mesh is
  /// unchanged.
  coupling::State transferred(SurfaceFields& before, const coupling::State& y, const Net& shape, std::span<const Body* const> bodies);

  /// Passes the state y to the fields. Also passes it to the capsule, unless `distance` > 0 and the capsule was last evaluated at a state within
  /// `distance` of y.
  void set_state(const coupling::State& y, double distance = 0);

  /// Calls set_state(y, distance). Returns the evaluation of the shape in y, see Capsule::evaluate_on_demand. `rate`: rate of y; absent if unknown.
  std::shared_ptr<coupling::Evaluation> evaluate(const coupling::State& y, const coupling::State& rate, double distance);

  /// Returns a function that evaluates all fields of particle p, scaled to order 1, at a parametric point in the state set last. The function is
  /// empty if there are no fields.
  surface::FieldsAt values_at(std::size_t p) const;

  /// Adds the contributions of the fields of particle p to the particle's row `now`, and the columns of its fields and registered loads to `to`. `y`
  /// must be the state that was set last by set_state().
  void add_to_row(std::size_t p, const coupling::State& y, DeformingRow& now, Columns& to) const;
  /// Returns the mass of the surfactant of particle p at the start of a run; 0 without surfactant.
  double initial_mass(std::size_t p) const;
  /// Returns the power of the loads of all fields if the surface material moves at the velocity v.
  double power(const Net& v) const;
  /// Adds the values that fields and loads write to snapshots at the shape x, and replaces the tensions of interfaces with surfactant by their values
  /// at the local concentration.
  void add_to_snapshot(const output::Nodes& nodes, const Net& x, std::vector<output::Field>& fields) const;

 private:
  struct One {
    std::size_t particle;
    std::unique_ptr<membrane::Field> field;
    membrane::Surfactant* surfactant = nullptr;  // `field` if it is a surfactant, otherwise null
    const membrane::FieldParts::Chosen* part = nullptr;  // user-defined part (see deck::Parts) that created this field; null for a built-in field
  };

  void add_registered(const output::Nodes& nodes, const Net& x, std::vector<output::Field>& fields) const;

  const std::vector<Member>& members_;
  coupling::Capsule& capsule_;
  std::vector<One> all_;
  std::optional<coupling::CoupledMotion> motion_;  // always set
};

/// Returns load, traction, displacement, velocity, tensions and mean curvature at the nodes, and the particle number if there are several particles.
/// `all`: stacked body of all members. x, `load` and `velocity` (fluid velocity, may be empty): control values of all members. Serial.
std::vector<output::Field> snapshot_fields(std::span<const Member> members, const Body& all, const output::Nodes& nodes, const Net& x,
                                           const Net& load, const Net& velocity);

/// Returns one lattice vector per node, to be added to the position of the node. It moves the node's particle so that the mean of the particle's
/// control points is in the cell around the origin.
output::Rows into_cell(std::span<const Member> members, const stokes::PeriodicCell& cell, const output::Nodes& nodes, const Net& x);

}  // namespace tanktread
