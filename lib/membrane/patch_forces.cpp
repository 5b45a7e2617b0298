#include "membrane/patch_forces.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "quadrature/gauss.hpp"
#include "spline/basis.hpp"
#include "surface/geometry.hpp"

namespace tanktread::membrane {

void PatchForce::declare(deck::Section& section) {
  if (!section.documenting())
    for (const char* key : {"direction", "radius", "force"})
      if (!section.given(key)) throw UserError(section.path(key) + " is missing: a force on a membrane needs `direction`, `radius` and `force`.");
  section.key("direction", direction, deck::any(), "1",
              "vector from the centroid of the unstressed shape (of the resting shape, if Membrane/stress-free shape is given) towards the "
              "middle of the membrane patch that the force acts on; its "
              "length has no effect (required; the default is not used)");
  section.key("radius", radius, deck::positive(), "length",
              "radius of the membrane patch that the force acts on: the largest distance of a point of the patch, on the unstressed membrane, from "
              "the ray from the centroid along `direction` (required; the default is not used)");
  section.key("force", force, deck::any(), "force",
              "components x1, x2, x3 of the total force on the membrane patch that the keys `direction` and `radius` of this force define "
              "(required; the default is not used). Its density per unstressed area varies like (1 - d^2/radius^2)^2 with the distance d from "
              "the line through the centroid along `direction`");
}

void PatchForces::declare(deck::Section& section) {
  section.each("a force on a patch of the membrane, for example by a bead in optical tweezers. It acts on fixed material points and keeps its "
               "direction",
               [this](const std::string& name, deck::Section& inner) {
                 all.emplace_back().name = name;
                 all.back().declare(inner);
               });
  if (section.documenting()) all.clear();
}

Vec3 PatchForces::total() const {
  Vec3 sum = Vec3::Zero();
  for (const PatchForce& one : all) sum += one.force;
  return sum;
}

void PatchForces::check() const {
  for (auto one = all.begin(); one != all.end(); ++one) {
    if (one->direction.norm() == 0) throw UserError("Membrane/forces/" + one->name + "/direction must not be zero.");
    for (auto other = one + 1; other != all.end(); ++other)
      if ((one->direction.normalized() - other->direction.normalized()).norm() < 1e-6)
        throw UserError("Membrane/forces: `" + one->name + "` and `" + other->name +
                        "` act on the same point: give one force, which is their sum.");
  }
}

namespace {

/// order: Gauss points per direction of each part of an element. Elements are divided into parts no longer than half the patch radius, at most
/// most_parts per direction.
constexpr int order = 6, most_parts = 32;

/// Returns the number of parts per direction into which the patch quadrature divides an element. Returns 0 if the element is farther from the patch
/// than half its own size, so that it cannot overlap the patch. `places`: 3 x 3 points of the element, relative to the centroid. `ray`: unit vector
/// from the centroid to the patch.
int parts(const std::array<Vec3, 9>& places, const Vec3& ray, double radius) {
  double longest = 0, nearest = INFINITY;
  for (const Vec3& x : places) {
    longest = std::max(longest, (x - places[4]).norm());
    if (x.dot(ray) > -longest) nearest = std::min(nearest, x.cross(ray).norm());
  }
  if (nearest > radius + longest) return 0;
  return std::clamp(static_cast<int>(std::ceil(4 * longest / radius)), 1, most_parts);
}

}  // namespace

Net PatchForces::virtual_work(const spline::Space& space, const Net& unstressed) const {
  const Vec3 centroid = surface::measures(space, unstressed).centroid;
  const quadrature::GaussRule& rule = quadrature::gauss(order);
  Net work = Net::Zero(space.n_points, 3);
  for (const PatchForce& one : all) {
    const Vec3 ray = one.direction.normalized();
    Eigen::VectorXd shares = Eigen::VectorXd::Zero(space.n_points);  // int N_A w dGamma_0 per control point A, with the weight function
                                                                    // w of the patch before its normalisation
    for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
      const auto place = [&](double s, double t) { return surface::point(space, unstressed, {e, s, t}); };
      std::array<Vec3, 9> places;
      for (int k = 0; k < 9; ++k) places[static_cast<std::size_t>(k)] = place(k % 3 / 2., k / 3 / 2.).x - centroid;
      const int n = parts(places, ray, one.radius);
      for (int i = 0; i < n * order; ++i)
        for (int j = 0; j < n * order; ++j) {
          const double s = (i / order + rule.nodes[i % order]) / n, t = (j / order + rule.nodes[j % order]) / n;
          const surface::Point at = place(s, t);
          const Vec3 from_centroid = at.x - centroid;
          const double inside = 1 - (from_centroid.cross(ray) / one.radius).squaredNorm();
          if (inside <= 0 || from_centroid.dot(ray) < 0) continue;
          const double weight = inside * inside * at.jacobian * rule.weights[i % order] * rule.weights[j % order] / (n * n);
          const Eigen::VectorXd basis = spline::basis(space.elements[e], s, t, 0).value;
          for (Eigen::Index a = 0; a < basis.size(); ++a) shares[space.elements[e].points[static_cast<std::size_t>(a)]] += weight * basis[a];
        }
    }
    if (shares.sum() <= 0)
      throw UserError("Membrane/forces/" + one.name + formatted(": there is no membrane within %g of its ray; give a larger radius.", one.radius));
    work += shares / shares.sum() * one.force.transpose();
  }
  return work;
}

/// Returns whether the reflection `image` maps the forces on the control points onto themselves.
bool PatchLoad::admits(const surface::Image& image) const {
  double defect = 0;
  for (Eigen::Index a = 0; a < work_.rows(); ++a)
    defect = std::max(defect, (work_.row(image.point[static_cast<size_t>(a)]) - work_.row(a).cwiseProduct(image.signs.transpose())).norm());
  return defect <= 1e-10 * work_.norm();
}

RigidConditions PatchLoad::rigid_conditions() const {
  std::vector<RigidConditions> all;
  for (const PatchForce& one : forces_) all.push_back(fixed_direction(one.force));
  return stacked(all);
}

}  // namespace tanktread::membrane
