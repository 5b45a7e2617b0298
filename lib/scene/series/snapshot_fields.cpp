#include "scene/series/snapshot_fields.hpp"

#include <algorithm>

#include "membrane/membrane.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

std::size_t particle_of(std::span<const Member> members, int element) {
  const auto after = std::ranges::upper_bound(members, element, {}, [](const Member& member) { return member.block.first_element; });
  return static_cast<std::size_t>(after - members.begin()) - 1;
}

}  // namespace

std::vector<output::Field> snapshot_fields(std::span<const Member> members, const Body& all, const output::Nodes& nodes, const Net& x,
                                           const Net& load, const Net& velocity) {
  const std::vector<spline::Site>& sites = nodes.mesh().sites;
  const auto n = static_cast<Eigen::Index>(sites.size());
  Net traction = nodes.values(load);
  std::vector<output::Field> fields{{"load", traction}};
  Eigen::MatrixX2d tensions(n, 2);
  Eigen::VectorXd curvature(n), particle(n);
  nodes.each_node(all.unstressed, x, [&](Eigen::Index i, const surface::Jet& before, const surface::Jet& now) {
    const std::size_t p = particle_of(members, sites[static_cast<std::size_t>(i)].element);
    if (load_measure(members[p].scene) == stokes::Measure::reference) traction.row(i) *= surface::jacobian(before) / surface::jacobian(now);
    if (members[p].scene.particle.rigid())
      tensions.row(i).setZero();
    else
      tensions.row(i) = membrane::tensions(members[p].body->law, std::span(&before, 1), std::span(&now, 1));
    curvature[i] = surface::mean_curvature(now);
    particle[i] = static_cast<double>(p + 1);
  });
  fields.push_back({"traction", traction});
  fields.push_back({"displacement", nodes.values(x - all.unstressed)});
  if (velocity.size() > 0) fields.push_back({"velocity", nodes.values(velocity)});
  fields.push_back({"smallest tension", tensions.col(0)});
  fields.push_back({"largest tension", tensions.col(1)});
  fields.push_back({"mean curvature", curvature});
  if (members.size() > 1) fields.push_back({"particle", particle});
  return fields;
}

output::Rows into_cell(std::span<const Member> members, const stokes::PeriodicCell& cell, const output::Nodes& nodes, const Net& x) {
  std::vector<Vec3> shifts;
  for (const Member& member : members) shifts.push_back(-cell.shift(member.block.rows(x).colwise().mean().transpose()));
  const std::vector<spline::Site>& sites = nodes.mesh().sites;
  output::Rows rows(static_cast<Eigen::Index>(sites.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) = shifts[particle_of(members, sites[static_cast<std::size_t>(i)].element)];
  return rows;
}

}  // namespace tanktread
