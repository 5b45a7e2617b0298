#include "system/solids/resistance.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "membrane/mass.hpp"
#include "surface/geometry.hpp"
#include "surface/partition.hpp"

namespace tanktread::coupling {

Resistance::Resistance(const spline::Space& space, const Net& surface, double viscosity, const quadrature::Options& quadrature,
                       const SolverOptions& solvers, Ranks& ranks, Phases& phases, Tube* tube,
                       const std::optional<stokes::PlaneWall>& wall)
    : space_(space),
      surface_(surface),
      viscosity_(viscosity),
      quadrature_(quadrature),
      ranks_(ranks),
      phases_(phases),
      layer_(stokes::Layer::Kernel::single_layer, space, space.collocation, quadrature),
      collocation_(solvers.direct),
      tube_(tube),
      wall_(wall),
      place_(surface),
      krylov_(solvers.of(solvers.traction)),
      tolerance_(solvers.tolerance) {
  const auto clock = phases_.time("assembly");
  own_points_ = surface::share(space, surface::partition(space, ranks.size()), ranks.rank()).points;
  ranks_.own(own_points_, space.n_points);
  sites_ = collocation_matrix(space);
  collocation_.factor(sites_);
  mass_ = membrane::MassMatrix(space, 8).update(surface);  // mass matrix by eight Gauss points per direction, because the area element is not a
                                                           // polynomial

  const surface::Geometry geometry(space);
  flux_ = geometry.volume_gradient(surface);
  membrane::DirectSolver mass(solvers.direct);
  mass.factor(mass_);
  normal_ = mass.solve(flux_);
  // Sets the scale s of (2.10) to 2 a / 3, because the single layer of a uniform density on a sphere of radius a is 2 a / 3 times the density.
  const double radius = std::cbrt(3 * geometry.volume(surface) / (4 * M_PI));
  weight_ = 2 * radius / 3 / flux_.cwiseProduct(normal_).sum();

  layer_.set_reference(surface);
  layer_.place(surface, stokes::Measure::reference);
  layer_.assemble(own_points_, rows_);
  if (tube_) {
    tube_->set_reference(surface);
    tube_->place(surface);
    factor();
  }
  if (!wall_) return;
  images_.emplace(stokes::Layer::Kernel::single_layer, space, space.collocation, quadrature);
  images_->set_wall(*wall_);
  images_->set_reference(surface);
  place_images();
}

void Resistance::place(const Net& x, const Mat3& turn) {
  place_ = x;
  turn_ = turn;
  if (tube_) tube_->place(x);
  if (wall_) place_images();
}

void Resistance::place_images() {
  const auto clock = phases_.time("assembly");
  const Net at = sites_ * place_;
  in_front_ = true;
  for (Eigen::Index i = 0; i < at.rows(); ++i) in_front_ = in_front_ && wall_->height(at.row(i).transpose()) > 0;
  if (!in_front_) return;
  images_->place(place_, stokes::Measure::reference);
  images_->assemble_images(own_points_, image_rows_);
  factor();
}

void Resistance::factor() {
  constexpr int most_points = 1500;
  factors_.reset();
  if (space_.n_points > most_points) return;
  const Eigen::Index n = 3 * static_cast<Eigen::Index>(space_.n_points);
  stokes::Rows<double> all = stokes::Rows<double>::Zero(n, n);
  for (std::size_t k = 0; k < own_points_.size(); ++k) {
    const auto from = 3 * static_cast<Eigen::Index>(k), to = 3 * static_cast<Eigen::Index>(own_points_[k]);
    all.middleRows<3>(to) = rows_.middleRows<3>(from);
    for (Eigen::Index column = 0; wall_ && column < n; column += 3)
      all.block<3, 3>(to, column) += turn_.transpose() * image_rows_.block<3, 3>(from, column) * turn_;
  }
  ranks_.add({all.data(), static_cast<std::size_t>(all.size())});
  const Net normal = sites_ * normal_;
  all += weight_ * Eigen::Map<const Eigen::VectorXd>(normal.data(), n) * Eigen::Map<const Eigen::RowVectorXd>(flux_.data(), n);
  factors_.emplace(all);
}

Net Resistance::ambient(const stokes::AmbientFlow& flow) const { return collocation_.solve(Net(flow.velocities(sites_ * place_) * turn_)); }

double Resistance::pressure_drop(const Net& f) { return tube_ ? -tube_->pressure_of(f * turn_.transpose()) : 0; }

double Resistance::lacking_pressure(const stokes::AmbientFlow& flow, const Net& f, double work) {
  if (!tube_ || !flow.duct()) return 0;
  const Net at_places = flow.velocities(between().values * place_);
  return tube_->lacking_pressure(between(), at_places, flow.amplitude(), f * turn_.transpose(), work);
}

const BetweenSites& Resistance::between() {
  if (!between_) between_ = between_sites(space_, surface_);
  return *between_;
}

/// Returns the product of f with the regularised first-kind operator (2.10), R^-1 A f + s c (b.f)/(b.c). A is the single layer, R the collocation
/// matrix, b_A = int N_A n dG, c = M^-1 b, and s a scale.
Net Resistance::apply(const Net& f) const {
  const Eigen::Map<const Eigen::VectorXd> flat(f.data(), f.size());
  Net u(f.rows(), 3);
  const Net in_space = wall_ ? Net(f * turn_.transpose()) : Net();
  for (size_t k = 0; k < own_points_.size(); ++k) {
    const auto row = 3 * static_cast<Eigen::Index>(k);
    for (int i = 0; i < 3; ++i)  // row by row, so that rounding does not depend on the number of rows of this rank
      u(own_points_[k], i) = rows_.row(row + i).dot(flat);
    if (!wall_) continue;
    Vec3 images;
    for (int i = 0; i < 3; ++i) images[i] = image_rows_.row(row + i).dot(Eigen::Map<const Eigen::VectorXd>(in_space.data(), in_space.size()));
    u.row(own_points_[k]) += images.transpose() * turn_;
  }
  ranks_.replicate(u);
  if (tube_) u -= viscosity_ * tube_->respond(f * turn_.transpose()).velocity * turn_;
  return collocation_.solve(u) + weight_ * flux_.cwiseProduct(f).sum() * normal_;
}

Net Resistance::force_density(const Net& u) {
  const auto clock = phases_.time("resistance solve");
  const Eigen::Index n = u.rows();
  const auto operation = [&](const double* in, double* out) { Eigen::Map<Net>(out, n, 3) = apply(Eigen::Map<const Net>(in, n, 3)); };
  const Net rhs = viscosity_ * u;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * n);
  const auto precondition = [&](const double* in, double* out) {
    const Net at_sites = sites_ * Eigen::Map<const Net>(in, n, 3);
    Eigen::Map<Eigen::VectorXd>(out, 3 * n) = factors_->solve(Eigen::Map<const Eigen::VectorXd>(at_sites.data(), 3 * n));
  };
  const LinearSystem system{{{"traction", 3 * n}}, operation, factors_ ? Apply(precondition) : Apply()};
  const SolveReport report = krylov_.solve(system, Eigen::Map<const Eigen::VectorXd>(rhs.data(), rhs.size()), f, tolerance_);
  iterations_ += last_iterations_ = report.iterations;
  require_convergence(report, "the first-kind system of the rigid surface", tolerance_);
  return Eigen::Map<const Net>(f.data(), n, 3);
}

stokes::Evaluations Resistance::kernel_evaluations() const {
  const stokes::Evaluations known = layer_.evaluations() + residual_evaluations_;
  return images_ ? known + images_->evaluations() : known;
}

Eigen::VectorXd Resistance::residual_work(const std::function<Net(const Net& x)>& u, const Net& f, std::span<const Net> z) {
  const auto clock = phases_.time("reciprocal correction");
  const auto& [sites, at_sites, weights] = between();
  const std::vector<int> own = ranks_.share(static_cast<int>(sites.size()));
  stokes::Layer layer(stokes::Layer::Kernel::single_layer, space_, sites, quadrature_);
  if (wall_) layer.set_wall(*wall_);
  layer.place(wall_ ? place_ : surface_);
  Net v = Net::Zero(at_sites.rows(), 3);
  layer.apply(wall_ ? Net(f * turn_.transpose()) : f, own, v);
  if (wall_) v *= turn_;
  if (tube_) {
    Net answer(v.rows(), 3);
    tube_->velocity_at(at_sites * place_, tube_->respond(f * turn_.transpose()), own, answer);
    for (const int i : own) v.row(i) -= viscosity_ * answer.row(i) * turn_;
  }
  ranks_.add({v.data(), static_cast<std::size_t>(v.size())});
  residual_evaluations_ += layer.evaluations();
  const Net rest = weights * (u(at_sites * surface_) - v / viscosity_);
  Eigen::VectorXd work(static_cast<Eigen::Index>(z.size()));
  for (std::size_t k = 0; k < z.size(); ++k) work[static_cast<Eigen::Index>(k)] = z[k].cwiseProduct(rest).sum();
  if (!tube_ || !tube_->fixed()) return work;
  const Tube::Leak leak = tube_->leak(-f * turn_.transpose());
  for (std::size_t k = 0; k < z.size(); ++k)
    work[static_cast<Eigen::Index>(k)] += tube_->work(leak, tube_->respond(-z[k] * turn_.transpose()));
  return work;
}

Vec3 Resistance::force(const Net& f) const {
  const Net weighted = mass_ * f;  // rows int N_A f dG, whose sum is int f dG
  return weighted.colwise().sum().transpose();
}

Vec3 Resistance::torque(const Net& f, const Vec3& centre) const {
  const Net weighted = mass_ * f;
  Vec3 torque = Vec3::Zero();
  for (Eigen::Index a = 0; a < f.rows(); ++a)
    torque += (surface_.row(a).transpose() - centre).cross(weighted.row(a).transpose());  // x = sum N_A x_A
  return torque;
}

Mat3 Resistance::stresslet(const Net& f, const Vec3& centre) const {
  const Net weighted = mass_ * f;
  const Mat3 moment = weighted.transpose() * (surface_.rowwise() - centre.transpose());
  return 0.5 * (moment + moment.transpose()) - moment.trace() / 3 * Mat3::Identity();
}

void Resistance::forget_recycled() const {
  krylov_.forget();
  if (tube_) tube_->forget_recycled();
}

}  // namespace tanktread::coupling
