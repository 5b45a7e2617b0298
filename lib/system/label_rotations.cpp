#include "system/label_rotations.hpp"

#include <cmath>

#include "surface/geometry.hpp"

namespace tanktread::coupling {

std::optional<Net> label_rotation(const spline::Space& space, const spline::Block& block, const Net& unstressed, const Net& x, int axis,
                                  const membrane::SymmetricSolver& collocation) {
  constexpr double fitted = 1e-2;  // a sphere of three elements a side is one to 1e-3
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
