#include "system/solids/solid_response.hpp"

#include <algorithm>

#include "system/collocation.hpp"
#include "system/solids/nearest_sites.hpp"

namespace tanktread::coupling {

using stokes::Layer;

namespace {

double distance(const SolidScene& scene) { return scene.planes.front().height(scene.planes.back().point()); }

/// Returns phi = z (D - z)/2 of (2.49) at the height z above the first of two plates at the distance D.
double profile(const SolidScene& scene, double height) { return height * (distance(scene) - height) / 2; }

Vec3 along(const stokes::PlaneWall& wall, const Vec3& v) { return v - wall.normal().dot(v) * wall.normal(); }

}  // namespace

Solids::Flow without_particles(const SolidScene& scene, const stokes::AmbientFlow& flow) {
  const Solids& solids = *scene.solids;
  Vec3 force = Vec3::Zero();
  if (scene.planes.empty()) force = solids.cell().volume() * flow.change() * scene.driving_gradient;
  return solids.solve(solids.velocities() * flow.change().transpose() - flow.velocities(solids.sites()), force);
}

Vec3 carried(const SolidScene& scene, const Solids::Flow& flow) {
  if (scene.planes.empty()) return scene.solids->cell().volume() * flow.drift;
  if (scene.planes.size() == 1) return Vec3::Zero();
  const stokes::PlaneWall& wall = scene.planes.front();
  const Eigen::VectorXd weights = scene.solids->moments([&](const Vec3& x) { return profile(scene, wall.height(x)); });
  return along(wall, flow.force.transpose() * weights) / scene.solids->viscosity();
}

SolidResponse::SolidResponse(const SolidScene& scene, const spline::Space& space, const stokes::AmbientFlow& flow)
    : scene_(scene),
      space_(space),
      flow_(flow),
      collocation_(collocation_matrix(space)),
      single_(Layer::Kernel::single_layer, space, {}, scene.quadrature) {
  single_.repeat(scene_.solids->cell(), {.across = scene_.solids->across()});
}

void SolidResponse::set_reference(const Net& unstressed, stokes::Measure measure, std::vector<bool> present) {
  single_.set_reference(unstressed, std::move(present));
  measure_ = measure;
}

void SolidResponse::set_contrasts(const Eigen::VectorXd& contrasts) {
  contrasts_ = contrasts;
  double_.reset();
  if (contrasts.isZero(0)) return;
  double_.emplace(Layer::Kernel::double_layer, space_, stokes::Sites(), scene_.quadrature);
  double_->repeat(scene_.solids->cell(), {.across = scene_.solids->across()});
}

void SolidResponse::place(const Net& x, const Net& at, std::span<const int> own) {
  if (shape_.rows() == x.rows() && shape_ == x && at_.rows() == at.rows() && at_ == at) return;
  shape_ = x, at_ = at;
  own_.assign(own.begin(), own.end());
  single_.place(x, measure_);
  areas_ = single_.moments(single_.weights());
  Solids& solids = *scene_.solids;
  solids.reach(x);
  solids_on_particles_ = solids.layer().near(at_, own_);
  if (!double_) return;
  double_->place(x);
  nearest_ = nearest_sites(collocation_ * x, solids.sites(), solids.own(), &solids.cell());
  double_on_solids_ = double_->near(solids.sites(), solids.own());
}

const Solids::Flow& SolidResponse::empty() {
  if (!empty_ || change_ != flow_.change()) empty_ = without_particles(scene_, flow_), change_ = flow_.change();
  return *empty_;
}

Solids::Flow SolidResponse::respond(const Net& f, const Net& v) {
  const Solids& solids = *scene_.solids;
  Vec3 force = Vec3::Zero();
  if (f.size() > 0) force = f.transpose() * areas_;
  const Net u = solids.ranks().filled(solids.sites().rows(), [&](Net& all) {
    Net part(all.rows(), 3);
    if (f.size() > 0) {
      single_.apply(f, solids.sites(), solids.own(), part);
      for (const int i : solids.own()) all.row(i) += part.row(i) / solids.viscosity();
    }
    if (v.size() > 0 && double_) {
      const Net strength = contrasts_.asDiagonal() * v;
      double_->apply(strength, nearest_values(strength), solids.sites(), solids.own(), part, &*double_on_solids_);
      for (const int i : solids.own()) all.row(i) -= part.row(i);
    }
  });
  return solids.solve(u, force);
}

void SolidResponse::velocities(const Solids::Flow& flow, Net& u) { scene_.solids->velocity_at(at_, own_, flow, u, &*solids_on_particles_); }

Vec3 SolidResponse::carried(const Solids::Flow& flow, const Net& f, const Net& v) {
  if (scene_.planes.size() != 2) return coupling::carried(scene_, flow);
  const stokes::PlaneWall& wall = scene_.planes.front();
  const Vec3& n = wall.normal();
  const auto height = [&](const std::vector<double> (&x)[3], std::size_t k) { return wall.height(Vec3(x[0][k], x[1][k], x[2][k])); };
  Vec3 sum = coupling::carried(scene_, flow);
  std::vector<double> weighted = single_.weights();
  for (std::size_t k = 0; k < weighted.size(); ++k) weighted[k] *= profile(scene_, height(single_.nodes(), k)) / scene_.solids->viscosity();
  if (f.size() > 0) sum -= f.transpose() * single_.moments(weighted);
  if (v.size() > 0 && double_) {  // stress of (2.49): sigma_i n = x_i n + slope (e_i (m.n) + m (e_i.n)), m: normal of the plates
    const Net strength = contrasts_.asDiagonal() * v;
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c) {
        std::vector<double> stress(double_->nodes()[0].size());
        for (std::size_t k = 0; k < stress.size(); ++k) {
          const Vec3 normal(double_->normals()[0][k], double_->normals()[1][k], double_->normals()[2][k]);
          const double slope = distance(scene_) / 2 - height(double_->nodes(), k);
          stress[k] = double_->nodes()[i][k] * normal[c] + slope * ((i == c ? n.dot(normal) : 0.) + n[c] * normal[i]);
        }
        sum[i] += double_->moments(stress).dot(strength.col(c));
      }
  }
  return along(wall, sum);
}

/// Returns, for each collocation point of the solids, the value of the field v at the nearest collocation point of the particles. Only the rank-owned
/// rows of the result are valid.
Net SolidResponse::nearest_values(const Net& v) const {
  const Net at_sites = collocation_ * v;
  return at_sites(nearest_, Eigen::all);
}

stokes::Evaluations SolidResponse::evaluations() const {
  const stokes::Evaluations sum = single_.evaluations();
  return double_ ? sum + double_->evaluations() : sum;
}

}  // namespace tanktread::coupling
