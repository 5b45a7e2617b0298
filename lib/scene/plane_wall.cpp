#include "scene/plane_wall.hpp"

#include "base/formatted.hpp"
#include "scene/room.hpp"
#include "scene/series/diagnostics.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

/// Returns the point of a surface that is nearest to the wall, or if the surface crosses the wall, the point farthest behind it.
Vec3 nearest(const stokes::PlaneWall& wall, const spline::Space& space, const Net& x) {
  const Net own = (x.rowwise() - wall.point().transpose()) * wall.axes().transpose();
  const surface::BezierMap map(space);
  return wall.point() + wall.axes().transpose() * surface::lowest(surface::Patches(map, own), 2);
}

/// Returns the data of one particle for the wall that is nearest to it. `number`: number of the particle in the deck, from 1.
WallRow row_of(std::span<const stokes::PlaneWall> walls, const spline::Space& space, const Net& x, int number) {
  WallRow row;
  for (const stokes::PlaneWall& wall : walls)
    if (const Vec3 place = nearest(wall, space, x); wall.height(place) < row.gap) row = {wall.height(place), number, place};
  return row;
}

}  // namespace

void check_in_front(const ParticleScene& particle_scene, const Body& body) {
  const WallRow row = row_of(particle_scene.wall.planes(), body.space, body.initial, 1);
  const Vec3& place = row.place;
  const double gap = row.gap, least = particle_scene.contact_length(particle_scene.wall.contact_gap);
  if (gap >= least) return;
  const std::string name = particle_scene.name.empty() ? "The particle" : particle_scene.path();
  const std::string where = formatted(" at [%.4g, %.4g, %.4g] ", place[0], place[1], place[2]);
  if (gap <= 0) throw NoRoom(name + " crosses the wall at the start:" + where + formatted("it reaches %.4g behind it.", -gap), gap);
  throw NoRoom(name + " starts too close to the wall:" + where +
                   formatted("the gap is %.4g, less than Wall/contact gap, %g R_C = %.4g.", gap, particle_scene.wall.contact_gap, least),
               gap);
}

void WallRow::add_columns(const Scene& scene, Columns& to) const {
  if (!to.when(scene.wall.present)) return;
  constexpr const char* wall = "; beside a plane wall";
  add_gap(gap, to);
  to.add(place, "x1 x2 x3",
         {"nearest_to_wall_", "length", "component # of the position of the surface point that is nearest to the plane wall", {}, wall});
  if (scene.has_gaps())
    to.add(particle,
           {"particle_at_wall", "1", "index of the particle that is nearest to the plane wall, from 1 in the order of the deck", {}, wall});
}

WallRow wall_row(std::span<const stokes::PlaneWall> walls, const std::vector<Member>& members, const Net& x) {
  WallRow nearest;
  for (std::size_t p = 0; p < members.size(); ++p)
    if (const WallRow one = row_of(walls, members[p].body->space, members[p].own(x), static_cast<int>(p) + 1); one.gap < nearest.gap) nearest = one;
  return nearest;
}

WallRow wall_row(std::span<const stokes::PlaneWall> walls, const Body& body, const Net& x) { return row_of(walls, body.space, x, 1); }

}  // namespace tanktread
