#include "app/plane_wall.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

/// The place of a surface that is nearest to the wall, or farthest behind it.
Vec3 nearest(const stokes::PlaneWall& wall, const spline::Space& space, const Net& x) {
  const Net own = (x.rowwise() - wall.point().transpose()) * wall.axes().transpose();
  const surface::BezierMap map(space);
  return wall.point() + wall.axes().transpose() * surface::lowest(surface::Patches(map, own), 2);
}

void add(const stokes::PlaneWall& wall, const spline::Space& space, const Net& x, int number, Moment& now) {
  const Vec3 place = nearest(wall, space, x);
  const double gap = wall.height(place);
  if (gap < now.at_wall.gap) now.at_wall = {gap, number, 0, place};
  now.gap = now.at_wall.gap;
}

}  // namespace

void check_in_front(const Scene& scene, const Body& body) {
  const stokes::PlaneWall wall = *scene.wall.plane();
  const Vec3 place = nearest(wall, body.space, body.initial);
  const double gap = wall.height(place), least = scene.wall.contact_gap * scene.radius();
  if (gap >= least) return;
  const std::string name = scene.name.empty() ? "The particle" : "Particles/" + scene.name;
  const std::string where = formatted(" at [%.4g, %.4g, %.4g] ", place[0], place[1], place[2]);
  if (gap <= 0) throw UserError(name + " crosses the wall at the start:" + where + formatted("it reaches %.4g behind it.", -gap));
  throw UserError(name + " starts too close to the wall:" + where +
                  formatted("the gap is %.4g, less than Wall/contact gap, %g R_C = %.4g.", gap, scene.wall.contact_gap, least));
}

void add_wall(const stokes::PlaneWall& wall, const std::vector<Member>& members, const Net& x, Moment& now) {
  for (std::size_t p = 0; p < members.size(); ++p) add(wall, members[p].body->space, members[p].own(x), static_cast<int>(p) + 1, now);
}

void add_wall(const stokes::PlaneWall& wall, const Body& body, const Net& x, Moment& now) { add(wall, body.space, x, 1, now); }

}  // namespace tanktread
