#include "system/coupled_motion.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tanktread::coupling {

namespace {
/// Returns the rows of a block of a net; an empty net stays empty.
Net rows_of(const spline::Block& block, const Net& net) { return net.rows() > 0 ? Net(block.rows(net)) : Net(); }
}  // namespace

CoupledMotion::CoupledMotion(Capsule& capsule, std::vector<FieldOnParticle> fields)
    : capsule_(capsule), fields_(std::move(fields)), n_(capsule.n_points()) {
  Eigen::Index first = 3 * n_;
  for (const FieldOnParticle& on : fields_) {
    const Particle& particle = capsule.particles()[on.particle];
    const Eigen::Index size = on.field->size();
    const double length = on.length > 0 ? on.length : particle.radius;
    blocks_.push_back({on, first, size, length * std::sqrt(particle.block.n_points / static_cast<double>(size)), particle.block, {}});
    if (capsule.symmetry().order() > 1) blocks_.back().symmetric = basis(blocks_.size() - 1, capsule.symmetry(), Vec3::Ones());
    first += size;
  }
  rows_ = (first + 2) / 3;
}

Eigen::SparseMatrix<double> CoupledMotion::basis(std::size_t k, const surface::Symmetry& symmetry, const Vec3& parity) const {
  const membrane::Field& field = *fields_[k].field;
  std::vector<std::vector<std::pair<int, double>>> maps;
  for (const surface::Image& g : symmetry.images()) {
    std::vector<std::pair<int, double>> map = field.images(g);
    if (map.empty()) {  // the columns are then all unit vectors
      maps.clear();
      break;
    }
    const double turned = surface::character(g.signs, parity);
    for (auto& [to, sign] : map) sign *= turned;
    maps.push_back(std::move(map));
  }
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<bool> met(static_cast<std::size_t>(field.size()), false);
  int n = 0;
  for (int i = 0; i < static_cast<int>(field.size()); ++i) {
    if (met[static_cast<std::size_t>(i)]) continue;
    std::map<int, double> sum{{i, 1}};  // unit vector of coefficient i plus its images under the symmetries: entries by index
    for (const auto& map : maps) sum[map[static_cast<std::size_t>(i)].first] += map[static_cast<std::size_t>(i)].second;
    for (const auto& [to, value] : sum) {
      met[static_cast<std::size_t>(to)] = true;
      if (sum[i] != 0) entries.emplace_back(to, n, std::copysign(1 / std::sqrt(static_cast<double>(sum.size())), value));
    }
    n += sum[i] != 0;
  }
  Eigen::SparseMatrix<double> columns(field.size(), n);
  columns.setFromTriplets(entries.begin(), entries.end());
  return columns;
}

bool CoupledMotion::knows_images(const surface::Symmetry& symmetry) const {
  return std::ranges::none_of(fields_, [&](const FieldOnParticle& on) {
    return std::ranges::any_of(symmetry.images(), [&](const surface::Image& g) { return on.field->images(g).empty(); });
  });
}

Net CoupledMotion::start(const Net& shape) const {
  Net y = with_shape(Net::Zero(rows_, 3), shape);
  for (std::size_t k = 0; k < blocks_.size(); ++k) set_coefficients(y, k, blocks_[k].field->start(blocks_[k].rows.rows(shape)));
  return y;
}

Net CoupledMotion::with_shape(Net y, const Net& shape) const {
  y.topRows(n_) = shape;
  return y;
}

Eigen::VectorXd CoupledMotion::coefficients(const Net& y, std::size_t k) const {
  return Eigen::Map<const Eigen::VectorXd>(y.data() + blocks_[k].first, blocks_[k].size) / blocks_[k].scale;
}

void CoupledMotion::set_coefficients(Net& y, std::size_t k, const Eigen::VectorXd& q) const {
  Eigen::Map<Eigen::VectorXd>(y.data() + blocks_[k].first, blocks_[k].size) = blocks_[k].scale * q;
}

void CoupledMotion::set_fields(const Net& y) {
  for (std::size_t k = 0; k < blocks_.size(); ++k) blocks_[k].field->set_state(blocks_[k].rows.rows(y), coefficients(y, k));
}

void CoupledMotion::set_state(const Net& y) {
  set_fields(y);
  Net load = Net::Zero(n_, 3);
  for (const Block& block : blocks_) block.rows.rows(load) -= block.field->load();
  capsule_.set_forces(&Capsule::Forces::fields, std::move(load));
}

Net CoupledMotion::velocity(const Net& y) {
  if (!y.allFinite()) return not_a_number(y);
  set_state(y);
  const Net x = shape(y), u = capsule_.velocity(x);
  if (!u.allFinite()) return not_a_number(y);
  Net rate = with_shape(Net::Zero(rows_, 3), u);
  const Net slip = slip_at(x);
  for (std::size_t k = 0; k < blocks_.size(); ++k) set_coefficients(rate, k, blocks_[k].field->rate(rows_of(blocks_[k].rows, slip)));
  return rate;
}

/// Returns the velocity of the fluids minus the velocity of the control points; empty if no control point slides.
Net CoupledMotion::slip_at(const Net& x) {
  if (!capsule_.slides()) return {};
  const std::shared_ptr<Evaluation> e = capsule_.evaluate(x);
  return e->fluid_velocity() - e->velocity();
}

Net CoupledMotion::defect(const Net& y, const Net& u) {
  if (!defect_spares_system()) return Dynamics::defect(y, u);
  if (!y.allFinite()) return not_a_number(y);
  set_state(y);
  Net missing = with_shape(-u, capsule_.defect(shape(y), shape(u)));
  for (std::size_t k = 0; k < blocks_.size(); ++k) set_coefficients(missing, k, blocks_[k].field->rate({}) - coefficients(u, k));
  return missing;
}

void CoupledMotion::freeze(const Net& y) {
  capsule_.freeze(shape(y));
  for (const Block& block : blocks_) block.field->freeze(block.rows.rows(y));
}

void CoupledMotion::linearise(const Net& y) {
  set_state(y);
  const Net slip = slip_at(shape(y));
  for (const Block& block : blocks_) block.field->linearise(rows_of(block.rows, slip));
  capsule_.linearise(shape(y));
}

/// Multiplies the change of shape in delta by the operator B of (4.2). Does not modify the changes of the fields.
Net CoupledMotion::velocity_product(const Net& delta) { return with_shape(delta, capsule_.jacobian().velocity_product(shape(delta))); }

/// Returns the left-hand side of an implicit step, delta - shift J delta with the Jacobian J (4.33). If no control points slide along an interface,
/// the rows of the shape are multiplied by B (4.2), so that no linear system with B needs to be solved, and each layer is applied once.
Net CoupledMotion::step(const Net& delta, double shift) {
  const FieldChange fields = field_change(delta);
  const CapsuleJacobian::RateChange change = capsule_.jacobian().step_change(shape(delta), shift, fields.load);
  Net result = with_shape(delta, change.rate);
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    set_coefficients(result, k, coefficients(delta, k) - shift * field_rate(k, delta, fields, change.slip));
  return result;
}

CoupledMotion::FieldChange CoupledMotion::field_change(const Net& delta) const {
  FieldChange change{{}, Net::Zero(n_, 3)};
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& block = blocks_[k];
    const Net dx = block.rows.rows(delta);
    change.values.push_back(block.field->value_change(dx, coefficients(delta, k)));
    block.rows.rows(change.load) += block.field->load_change(dx, change.values.back());
  }
  return change;
}

/// Returns the change of the rate of field k. `slip`: change of the slip velocity of all particles; empty if no control points slide.
Eigen::VectorXd CoupledMotion::field_rate(std::size_t k, const Net& delta, const FieldChange& fields, const Net& slip) const {
  const Block& block = blocks_[k];
  return block.field->rate_change(block.rows.rows(delta), fields.values[k], rows_of(block.rows, slip));
}

/// Solves step(delta) - shift secants(delta) = rhs for the change of state delta.
Net CoupledMotion::system(double shift, const Net& rhs, double tolerance, const Secants& secants) {
  const auto apply = [&](const Net& delta) -> Net { return step(delta, shift) - shift * secants(delta); };
  const auto precondition = [&](Net delta) {
    delta = with_shape(std::move(delta), capsule_.jacobian().step_preconditioner(shape(delta)));
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const Block& block = blocks_[k];
      membrane::Field& field = *block.field;
      Eigen::VectorXd r = coefficients(delta, k);
      if (field.follows_shape()) {
        const Net dx = block.rows.rows(delta);
        r += shift * field.rate_change(dx, field.value_change(dx, Eigen::VectorXd::Zero(block.size)), {});
      }
      set_coefficients(delta, k, field.solve(shift, r));
    }
    return delta;
  };
  Net delta = capsule_.jacobian().solve_step(shift, on_nets(rows_, apply), on_nets(rows_, precondition), rhs, tolerance);
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    Eigen::VectorXd q = coefficients(delta, k);
    blocks_[k].field->conserve(coefficients(rhs, k), q);
    set_coefficients(delta, k, q);
  }
  return symmetric(std::move(delta));
}

Net CoupledMotion::solve(double shift, const Net& r, double tolerance, const Secants& secants) {
  return system(shift, velocity_product(r), tolerance, secants);
}

Net CoupledMotion::correction(double shift, const Net& defect, double tolerance, const Secants& secants) {
  return defect_spares_system() ? system(shift, shift * defect, tolerance, secants) : Dynamics::correction(shift, defect, tolerance, secants);
}

Net CoupledMotion::jacobian_error(const Net& change, const Net& delta, double shift) {
  return (defect_spares_system() ? change : velocity_product(change)) + step(delta, shift) / shift;
}

Net CoupledMotion::derivative(const Net& y, const Net& v, const Net& delta) {
  if (!capsule_.has_frozen()) return difference(y, v, delta);
  linearise(y);
  const FieldChange fields = field_change(delta);
  const CapsuleJacobian::RateChange change = capsule_.jacobian().velocity_change(shape(delta), fields.load);
  Net rate = with_shape(Net::Zero(rows_, 3), change.rate);
  for (std::size_t k = 0; k < blocks_.size(); ++k) set_coefficients(rate, k, field_rate(k, delta, fields, change.slip));
  return symmetric(std::move(rate));
}

Net CoupledMotion::mesh_motion(const Net& delta) {
  const Net motion = capsule_.mesh_motion(shape(delta));
  return motion.rows() > 0 ? with_shape(Net::Zero(rows_, 3), motion) : Net();
}

void CoupledMotion::restore_constraints(Net& y) {
  Net x = shape(y);
  capsule_.restore_constraints(x);
  y.topRows(n_) = x;
}

void CoupledMotion::improve_start(Net& y, const Net& before, double shift) {
  Net x = shape(y);
  capsule_.improve_start(x, shape(before), shift);
  y.topRows(n_) = x;
}

Net CoupledMotion::moved(const Net& y, const RigidMotion& motion) const {
  return with_shape(Net::Zero(y.rows(), 3), rigid_velocity(shape(y), motion, Vec3::Zero()));
}

Net CoupledMotion::slid(const Net& y, const Net& along) {
  set_fields(y);
  Net change = with_shape(Net::Zero(rows_, 3), along);
  for (std::size_t k = 0; k < blocks_.size(); ++k) set_coefficients(change, k, blocks_[k].field->relabelled(blocks_[k].rows.rows(along)));
  return change;
}

Net CoupledMotion::conserved(std::size_t k) const {
  const Eigen::VectorXd of_q = blocks_[k].field->conserved();
  if (of_q.size() == 0) return {};
  Net gradient = Net::Zero(rows_, 3);
  set_coefficients(gradient, k, of_q / (blocks_[k].scale * blocks_[k].scale));
  return gradient;
}

std::vector<Net> CoupledMotion::relabellings(const Net& y) {
  std::vector<Net> all;
  for (const Net& slide : capsule_.relabellings(shape(y))) all.push_back(slid(y, slide));
  return all;
}

Net CoupledMotion::symmetric(Net rate) const {
  rate = with_shape(std::move(rate), capsule_.symmetric(shape(rate)));
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Eigen::SparseMatrix<double>& basis = blocks_[k].symmetric;
    if (basis.size() > 0) set_coefficients(rate, k, basis * (basis.transpose() * coefficients(rate, k)).eval());
  }
  return rate;
}

double CoupledMotion::norm(const Net& displacement) const {
  double largest = capsule_.norm(shape(displacement));
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const double changed = coefficients(displacement, k).norm() / std::sqrt(static_cast<double>(blocks_[k].size));
    largest = changed <= largest ? largest : changed;  // written so that the maximum is NaN if a norm is NaN
  }
  return largest;
}

}  // namespace tanktread::coupling
