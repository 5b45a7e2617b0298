#include "system/symmetry.hpp"

#include <algorithm>
#include <cmath>

#include "deck/section.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {

void SymmetryOptions::declare(deck::Section& section) {
  section.key("use", use, deck::Choice{"auto", "none"},
              "use of the symmetries of flow, particles and mesh. `auto`: finds the mirror planes, half turns and point symmetry that they "
              "have in common, and solves only for control points that are not images of other control points. The particle keeps these "
              "symmetries for the whole run, which excludes instabilities that break them, for example wrinkles or a drift. `none`: solves "
              "for all control points; rounding errors may then grow");
}

bool keeps(const stokes::AmbientFlow& flow, const surface::Image& image, const Net& net) {
  const auto turn = image.signs.asDiagonal();
  double defect = 0, size = 0, gradient_defect = 0, gradient_size = 0;
  for (Eigen::Index a = 0; a < net.rows(); ++a) {
    const Vec3 x = net.row(a).transpose(), y = net.row(image.point[static_cast<size_t>(a)]).transpose();
    const Vec3 v = flow.velocity(x);
    const Mat3 gradient = flow.gradient(x);
    defect = std::max(defect, (flow.velocity(y) - turn * v).norm());
    gradient_defect = std::max(gradient_defect, (flow.gradient(y) - turn * gradient * turn).norm());
    size = std::max(size, v.norm());
    gradient_size = std::max(gradient_size, gradient.norm());
  }
  return defect <= 1e-10 * size && gradient_defect <= 1e-10 * gradient_size;
}

/// Returns whether the lattice has the symmetry: the image of every lattice vector is a lattice vector. If the flow has the symmetry too, it also
/// convects the lattice vectors symmetrically, so that the result remains true at all times.
static bool keeps(const stokes::PeriodicCell& cell, const surface::Image& image) {
  for (int d = 0; d < cell.n(); ++d) {
    Vec3 steps = cell.coordinates(image.signs.cwiseProduct(cell.vectors().col(d)));
    for (int k = 0; k < cell.n(); ++k) steps[k] -= std::round(steps[k]);
    if (steps.norm() > 1e-10) return false;
  }
  return true;
}

static bool admit(const LoadList& loads, const surface::Image& image) {
  return std::ranges::all_of(loads, [&](const auto& load) { return load->admits(image); });
}

surface::Symmetry symmetry(const SymmetryOptions& options, const spline::Space& space, std::span<const Net* const> nets,
                           const stokes::AmbientFlow& flow, const LoadList& loads, const stokes::Medium* medium,
                           const std::optional<stokes::PeriodicCell>& cell) {
  if (options.use == "none") return surface::Symmetry(space.n_points);
  const std::vector<stokes::AmbientFlow> flows = flow.rotated_copies();
  return surface::symmetry(space, nets, [&](const surface::Image& image) {
    return (!medium || medium->keeps(image.signs)) && (!cell || keeps(*cell, image)) && admit(loads, image) &&
           std::ranges::all_of(flows, [&](const auto& each) { return keeps(each, image, *nets[0]); });
  });
}

surface::Symmetry symmetry(const SymmetryOptions& options, const spline::Space& space, std::span<const Net* const> nets,
                           const surface::TubeWall& wall, const LoadList& loads) {
  if (options.use == "none") return surface::Symmetry(space.n_points);
  const Net* around[] = {&wall.net};
  return surface::symmetry(space, nets, [&](const surface::Image& image) {
    const auto keeps_middle = [&](const Net* net) {
      const Vec3 apart = surface::middle(*net) - surface::middle(wall.net);
      return (image.signs.cwiseProduct(apart) - apart).norm() <= 1e-9 * wall.radius();
    };
    return image.signs[0] > 0 && admit(loads, image) &&
           std::ranges::all_of(nets, keeps_middle) && surface::image(wall.space, around, image.signs).has_value();
  });
}

std::optional<Net> label_rotation(const spline::Space& space, const spline::Block& block, const Net& unstressed, const Net& x, int axis,
                                  const membrane::SymmetricSolver& collocation) {
  // A rotation counts as a map of the unstressed surface onto itself if the normal component of its velocity is at most this fraction of the velocity
  // (root mean squares). On a fitted sphere with 3 x 3 elements per face the fraction is 1e-3.
  constexpr double fitted = 1e-2;
  const Vec3 centre = block.rows(unstressed).colwise().mean().transpose();
  Net field = Net::Zero(x.rows(), 3);
  double across = 0, all = 0;
  for (int i = block.first_point; i < block.first_point + block.n_points; ++i) {
    const spline::Site& site = space.collocation[static_cast<std::size_t>(i)].front();
    const surface::Point before = surface::point(space, unstressed, site), now = surface::point(space, x, site);
    if (!(before.jacobian > 1e-9 * (before.a1.squaredNorm() + before.a2.squaredNorm()))) return {};
    const Vec3 turn = Vec3::Unit(axis).cross(before.x - centre);
    across += std::pow(turn.dot(before.n), 2), all += turn.squaredNorm();
    const double s = turn.cross(before.a2).dot(before.n) / before.jacobian, t = before.a1.cross(turn).dot(before.n) / before.jacobian;
    field.row(i) = (s * now.a1 + t * now.a2).transpose();
  }
  if (across > fitted * fitted * all) return {};
  return collocation.solve(field);
}

}  // namespace tanktread::coupling
