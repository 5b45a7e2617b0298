#pragma once
// Motion of capsules and drops together with the fields on their surfaces, for all time integrators.

#include <vector>

#include <Eigen/SparseCore>

#include "membrane/field.hpp"
#include "system/capsule.hpp"

namespace tanktread::coupling {

/// State y = (x, q_1, q_2, ...): the control net of all particles, followed by the coefficients of each field. Coefficients are stored contiguously
/// in rows of three, and the last row is padded with zeros. The coefficients of a field are multiplied by R_C sqrt(control points/coefficients) of
/// their particle, so that the Euclidean inner product of states gives similar weight to fields and shape and does not depend on the unit of length.
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
    double length = 0;  ///< length that replaces R_C in the factor of the field's coefficients (see CoupledMotion); 0: R_C
  };

  /// `capsule` and the fields must outlive this object.
  CoupledMotion(Capsule& capsule, std::vector<FieldOnParticle> fields);

  Net start(const Net& shape) const;                         ///< state at the start of a run with this shape
  Net shape(const Net& y) const { return y.topRows(n_); }    ///< control net
  Net with_shape(Net y, const Net& shape) const;             ///< the state y with `shape` as its control net
  Eigen::VectorXd coefficients(const Net& y, std::size_t k) const;
  void set_coefficients(Net& y, std::size_t k, const Eigen::VectorXd& q) const;
  const std::vector<FieldOnParticle>& fields() const { return fields_; }
  Eigen::Index n_rows() const { return rows_; }  ///< number of rows of a state

  /// Returns an orthonormal basis, one vector per column, of the coefficients of field k that have this parity under the symmetry. If the field
  /// cannot map its coefficients to mirror images, the basis spans all coefficients.
  Eigen::SparseMatrix<double> basis(std::size_t k, const surface::Symmetry& symmetry, const Vec3& parity) const;
  bool knows_images(const surface::Symmetry& symmetry) const;  ///< true if all fields can map their coefficients to mirror images

  /// Returns the gradient, with respect to the state y, of the sum that field k conserves, for example the mass of a surfactant. The result has no
  /// rows if the field conserves no sum.
  Net conserved(std::size_t k) const;

  /// Returns the change of the state y if control points slide by the small displacement `along` on surfaces that do not move.
  Net slid(const Net& y, const Net& along);

  /// Sets the fields to the state y. Unlike set_state(), does not add their loads to the loads of the capsule.
  void set_fields(const Net& y);
  /// Sets the fields to the state y and adds their loads to the loads of the capsule. Does not set the capsule's shape, which is an argument of the
  /// capsule's functions.
  void set_state(const Net& y);

  Net velocity(const Net& y) override;
  std::string why_undefined() const override { return capsule_.why_undefined(); }
  void set_time(double time, double start) override { capsule_.set_time(time, start); }
  double next_kink(double time) const override { return capsule_.next_kink(time); }
  void freeze(const Net& y) override;
  bool lattice_moves() const override { return capsule_.lattice_moves(); }
  double frozen_bytes() const override { return capsule_.frozen_bytes(); }
  void linearise(const Net& y) override;
  Net solve(double shift, const Net& r, double tolerance, const Secants& secants) override;
  Net defect(const Net& y, const Net& u) override;
  bool defect_spares_system() const override { return capsule_.defect_spares_system(); }
  Net correction(double shift, const Net& defect, double tolerance, const Secants& secants) override;
  Net jacobian_error(const Net& change, const Net& delta, double shift) override;
  Net derivative(const Net& y, const Net& v, const Net& delta) override;
  Net mesh_motion(const Net& delta) override;
  void restore_constraints(Net& y) override;
  void improve_start(Net& y, const Net& before, double shift) override;
  std::vector<Net> relabellings(const Net& y) override;
  Net moved(const Net& y, const RigidMotion& motion) const override;
  Net turned(const Net& y, const Mat3& rotation) const override { return with_shape(y, shape(y) * rotation.transpose()); }
  Net symmetric(Net rate) const override;
  double distance(const Net& from, const Net& to) const override { return capsule_.distance(shape(from), shape(to)); }
  /// Returns the largest of these values: Capsule::norm of the displacement of the shape and, for each field, the root mean square change of its
  /// coefficients.
  double norm(const Net& displacement) const override;

 private:
  struct Block : FieldOnParticle {
    Eigen::Index first, size;  // position and number of the coefficients within a state
    double scale;
    spline::Block rows;        // rows of the particle in the control net
    Eigen::SparseMatrix<double> symmetric;  // basis of symmetric coefficients; empty if the scene has no symmetry
  };
  /// Changes of the values of all fields (Field::value_change), and of the virtual work of their loads.
  struct FieldChange {
    std::vector<Eigen::VectorXd> values;
    Net load;
  };
  FieldChange field_change(const Net& delta) const;
  Eigen::VectorXd field_rate(std::size_t k, const Net& delta, const FieldChange& fields, const Net& slip) const;
  Net velocity_product(const Net& delta);
  Net step(const Net& delta, double shift);
  Net system(double shift, const Net& rhs, double tolerance, const Secants& secants);
  Net slip_at(const Net& x);

  Capsule& capsule_;
  std::vector<FieldOnParticle> fields_;
  std::vector<Block> blocks_;
  Eigen::Index n_, rows_;  // n_: number of control points. rows_: number of rows of a state
};

}  // namespace tanktread::coupling
