#pragma once
// Motion of capsules and drops together with the fields on their surfaces, for all time integrators.

#include <memory>
#include <string>
#include <vector>

#include "membrane/field.hpp"
#include "system/capsule.hpp"
#include "system/dynamics.hpp"

namespace tanktread::coupling {

/// Motion of all particles and of the fields q_1, q_2, ... on them. A state y = (x, q_1, q_2, ...) has one block "shape" per particle, whose
/// rows are its control points, and then one block per field with its coefficients. The blocks of the shapes follow one another, so that the stacked
/// control net x of all particles is one part of the state. The unit of a field's block is 1/(R_C sqrt(control points/coefficients)) of its
/// particle, so that the Euclidean inner product of states gives similar weight to fields and shape and does not depend on the unit of length.
///
///   dx/dt = u(x, q),   dq/dt = rate(x, q, v - u),   with the load of each field added to the load of its particle                (4.33)
///
/// Here u is the velocity of the control points, v is the velocity of the fluids at them, and `rate` is Field::rate. The Jacobian of the fields is
/// exact. The Krylov solver solves for x and q together. The preconditioner contains the diagonal block of each field. If the field relaxes to the
/// shape in a short time (Field::follows_shape), it also contains the block with the change of `rate` due to a change of x. Calls are collective;
/// every rank stores all fields.
class CoupledMotion : public Dynamics {
 public:
  struct FieldOnParticle {
    std::size_t particle;
    membrane::Field* field;
    std::string name;   ///< name of the field's block; different for all fields of a particle
    double length = 0;  ///< length that replaces R_C in the unit of the field's coefficients (see CoupledMotion); 0: R_C
  };

  /// `capsule` and the fields must outlive this object.
  explicit CoupledMotion(Capsule& capsule, std::vector<FieldOnParticle> fields = {});

  Capsule& capsule() const { return capsule_; }
  const std::vector<FieldOnParticle>& fields() const { return fields_; }
  bool knows_images(const surface::Symmetry& symmetry) const;  ///< true if all fields can map their coefficients to mirror images
  /// Returns a layout with the blocks of states, for vectors with this symmetry and parity (see Layout).
  std::shared_ptr<const Layout> layout(const surface::Symmetry& symmetry, const Vec3& of_planes = Vec3::Ones()) const;

  State start(const Net& shape) const;     ///< state at the start of a run with this shape
  State state_of(const Net& shape) const;  ///< state or rate with this net and zero coefficients
  /// Return a view of the stacked control net in a state, or in a rate.
  Eigen::Map<const Net> shape(const State& y) const { return {y.numbers().data(), capsule_.n_points(), 3}; }
  Eigen::Map<Net> shape(State& y) const { return {y.numbers().data(), capsule_.n_points(), 3}; }
  BlockId id(std::size_t k) const { return {layout_->blocks().size() - fields_.size() + k}; }  ///< block of field k
  Eigen::VectorXd coefficients(const State& y, std::size_t k) const { return y.value(id(k)); }

  /// Returns the gradient, with respect to the state y, of the sum that field k conserves, for example the mass of a surfactant. The result is absent
  /// if the field conserves no sum.
  State conserved(std::size_t k) const;

  /// Returns the change of the state y if control points slide by the small displacement `along` on surfaces that do not move.
  State slid(const State& y, const Net& along);

  /// Sets the fields to the state y. Unlike set_state(), does not add their loads to the loads of the capsule, which need not exist any more.
  void set_fields(const State& y);
  /// Sets the fields to the state y and adds their loads to the loads of the capsule. Does not set the capsule's shape, which is an argument of the
  /// capsule's functions.
  void set_state(const State& y);

  State velocity(const State& y) override;
  std::string why_undefined() const override;
  void set_time(double time, double start) override { capsule_.set_time(time, start); }
  double next_kink(double time) const override { return capsule_.flow().next_kink(time); }
  void freeze(const State& y) override;
  bool lattice_moves() const override { return capsule_.lattice_moves(); }
  double frozen_bytes() const override { return capsule_.frozen_bytes(); }
  void linearise(const State& y) override;
  State solve(double shift, const State& r, double tolerance, const Secants& secants) override;
  State defect(const State& y, const State& u) override;
  bool defect_spares_system() const override { return capsule_.defect_spares_system(); }
  State correction(double shift, const State& defect, double tolerance, const Secants& secants) override;
  State jacobian_error(const State& change, const State& delta, double shift) override;
  State derivative(const State& y, const State& v, const State& delta) override;
  State mesh_motion(const State& delta) override;
  void restore_constraints(State& y) override;
  void improve_start(State& y, const State& before, double shift) override;
  std::vector<State> relabellings(const State& y) override;
  State symmetric(State rate) const override;
  double distance(const State& from, const State& to) const override { return capsule_.distance(shape(from), shape(to)); }
  /// Returns the largest of these values: Capsule::norm of the displacement of the shape and, for each field, the root mean square change of its
  /// coefficients.
  double norm(const State& displacement) const override;

 private:
  /// Changes of the values of all fields (Field::value_change), and of the virtual work of their loads; the load has no rows without fields.
  struct FieldChange {
    std::vector<Eigen::VectorXd> values;
    Net load;
  };
  Net rows(std::size_t k, const Net& net) const;
  Net shape_at(std::size_t k, const State& y) const { return y(BlockId{fields_[k].particle}); }  ///< rows of the particle of field k
  FieldChange field_change(const State& delta) const;
  Eigen::VectorXd field_rate(std::size_t k, const State& delta, const FieldChange& fields, const Net& slip) const;
  BlockVector in_step(State delta, const Eigen::VectorXd& added = {}) const;
  State state_in(BlockVector step) const;
  Eigen::VectorXd added_in(const BlockVector& step) const;
  BlockVector velocity_product(State delta);
  BlockVector step(const State& delta, const Eigen::VectorXd& added, double shift);
  BlockVector preconditioned(const BlockVector& r, double shift) const;
  State system(double shift, const BlockVector& rhs, double tolerance, const Secants& secants);
  Net slip_at(const Net& x);

  Capsule& capsule_;
  std::vector<FieldOnParticle> fields_;
  std::shared_ptr<const Layout> layout_;
  std::shared_ptr<const Layout> step_;  // of implicit steps: blocks of states, and then blocks of the equations that the program adds
};

}  // namespace tanktread::coupling
