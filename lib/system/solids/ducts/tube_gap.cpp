// Distance of the particle in a tube to the wall.

#include <algorithm>
#include <limits>
#include <span>
#include <stdexcept>

#include "base/indices.hpp"
#include "surface/clearance.hpp"
#include "surface/closest_points.hpp"
#include "system/solids/ducts/tube_particle.hpp"

namespace tanktread::coupling {

bool Tube::inside(const Net& x, std::span<const int> rows) const {
  const surface::TubeWall& wall = wall_->surface();
  return std::ranges::all_of(rows, [&](int i) {
    const Vec3 place = x.row(i).transpose();
    switch (wall.kind) {
      case surface::DuctKind::straight_tube:
        return (place.tail<2>() - wall.outline.centroid()).norm() < inner_radius_ || wall.outline.inside(place.tail<2>());
      case surface::DuctKind::channel: return wall.channel->inside(place);
    }
    throw std::logic_error("unknown DuctKind");
  });
}

double Tube::gap() const {
  switch (wall().kind) {
    case surface::DuctKind::straight_tube: return gap_to_straight_wall();
    case surface::DuctKind::channel: return gap_to_channel_wall();
  }
  throw std::logic_error("unknown DuctKind");
}

/// Returns the gap to the wall of a straight tube, from the clearance between the particle and the outline of the cross-section.
double Tube::gap_to_straight_wall() const {
  return surface::clearance(surface::Patches(particle_->geometry.bezier(), particle_->shape), wall().outline).gap;
}

/// Returns the gap to the wall of a channel, from the closest points of the two surfaces. Of elements that are images of each other, searches one.
double Tube::gap_to_channel_wall() const {
  const auto points = [&](int e) -> std::span<const int> { return particle_->space.elements[static_cast<std::size_t>(e)].points; };
  const std::vector<int> elements =
      surface::fundamental_elements(particle_->parameters.symmetry, static_cast<int>(particle_->space.elements.size()), points).element;
  const double radius = wall().radius(), nearest = surface::gap_to_wall(particle_->geometry.bezier(), particle_->shape, elements, wall_->boxes(),
                                                                        wall().period, 1e-5 * radius, radius);
  return inside(particle_->sites(), indices(particle_->sites().rows())) ? nearest : -nearest;
}

}  // namespace tanktread::coupling
