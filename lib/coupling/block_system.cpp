#include "coupling/block_system.hpp"

namespace tanktread::coupling {

namespace {

double dot(const Net& a, const Net& b) { return a.cwiseProduct(b).sum(); }

/// Four blocks in one flat vector; f^D and dp times the unit.
class Layout {
 public:
  Layout(Eigen::Index particle, Eigen::Index wall, double unit) : particle_(particle), wall_(wall), unit_(unit) {}
  Eigen::Index size() const { return 3 * particle_ + 3 * wall_ + 2; }

  BlockVector unknowns(const double* in) const { return taken(in, 1 / unit_); }
  BlockVector residuals(const double* in) const { return taken(in, 1); }
  void put_unknowns(const BlockVector& x, double* out) const { put(x, unit_, out); }
  void put_residuals(const BlockVector& r, double* out) const { put(r, 1, out); }

 private:
  BlockVector taken(const double* in, double scale) const {
    const double* const rest = in + 3 * (particle_ + wall_);
    return {Eigen::Map<const Net>(in, particle_, 3), scale * Eigen::Map<const Net>(in + 3 * particle_, wall_, 3), scale * rest[0], rest[1]};
  }
  void put(const BlockVector& x, double scale, double* out) const {
    Eigen::Map<Net>(out, particle_, 3) = x.velocity;
    Eigen::Map<Net>(out + 3 * particle_, wall_, 3) = scale * x.wall_traction;
    out[3 * (particle_ + wall_)] = scale * x.pressure_drop;
    out[3 * (particle_ + wall_) + 1] = x.multiplier;
  }

  Eigen::Index particle_, wall_;
  double unit_;
};

/// The rows of (2.5) to (2.8); the one of dp times the unit.
BlockVector product(const BlockSystem& s, const BlockVector& x) {
  Tube& tube = s.tube;
  BlockVector r;
  const Net answer = tube.wall_on_particle(x.wall_traction) + x.pressure_drop * tube.inlet_on_particle();
  r.velocity = s.viscous(x.velocity) - s.control_values(answer);
  r.wall_traction = tube.wall_on_wall(x.wall_traction) - x.pressure_drop * tube.inlet_on_wall() - tube.velocity_on_wall(x.velocity);
  r.pressure_drop = s.unit * (x.pressure_drop - tube.pressure_of({}, x.velocity));
  r.multiplier = x.multiplier;
  if (s.flux.size() > 0) {
    r.velocity += x.multiplier * s.normal;
    r.multiplier = dot(s.flux, x.velocity) / dot(s.flux, s.normal);
  }
  return r;
}

/// Velocity and multiplier with B = 1.
void solve_particle(const BlockSystem& s, const BlockVector& r, BlockVector& x) {
  x.velocity = r.velocity;
  x.multiplier = r.multiplier;
  if (s.flux.size() == 0) return;
  x.multiplier = dot(s.flux, r.velocity) / dot(s.flux, s.normal) - r.multiplier;
  x.velocity -= x.multiplier * s.normal;
}

BlockVector diagonal(const BlockSystem& s, const BlockVector& r) {
  BlockVector x;
  solve_particle(s, r, x);
  x.pressure_drop = r.pressure_drop / s.unit;
  x.wall_traction = s.tube.solve_wall(r.wall_traction);
  return x;
}

BlockVector triangular(const BlockSystem& s, const BlockVector& r) {
  BlockVector x;
  solve_particle(s, r, x);
  x.pressure_drop = r.pressure_drop / s.unit + s.tube.pressure_of({}, x.velocity);
  x.wall_traction = s.tube.solve_wall(r.wall_traction + x.pressure_drop * s.tube.inlet_on_wall() + s.tube.velocity_on_wall(x.velocity));
  return x;
}

}  // namespace

SolveReport solve(const BlockSystem& system, const BlockForm& form, const Krylov& krylov, const BlockVector& rhs, BlockVector& x, double tolerance) {
  const Layout layout(rhs.velocity.rows(), rhs.wall_traction.rows(), system.unit);
  const auto apply = [&](const double* in, double* out) { layout.put_residuals(product(system, layout.unknowns(in)), out); };
  const auto with = [&](auto inverse) -> Krylov::Apply {
    return [&, inverse](const double* in, double* out) { layout.put_unknowns(inverse(system, layout.residuals(in)), out); };
  };
  const Krylov::Apply precondition = form == "block triangular" ? with(triangular) : form == "block diagonal" ? with(diagonal) : Krylov::Apply{};
  Eigen::VectorXd flat(layout.size()), right(layout.size());
  layout.put_unknowns(x, flat.data());
  BlockVector scaled = rhs;
  scaled.pressure_drop *= system.unit;
  layout.put_residuals(scaled, right.data());
  const SolveReport report = krylov.solve(apply, right, flat, tolerance, precondition);
  x = layout.unknowns(flat.data());
  return report;
}

}  // namespace tanktread::coupling
