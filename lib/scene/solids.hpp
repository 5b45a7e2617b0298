#pragma once
// Plates and posts of a scene: their surfaces, and their data in the results.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "base/timing.hpp"
#include "scene/member.hpp"
#include "scene/scene.hpp"
#include "system/solids/plates/solid_response.hpp"

namespace tanktread {

/// Returns the plates and posts of a scene with the factored operator of their tractions; nothing if the scene has no plates and posts. Collective.
std::optional<coupling::SolidScene> make_solids(const Scene& scene, Phases& phases);

/// Throws NoRoom if the particle crosses a post at the start.
void check_outside_of_posts(const Scene& scene, const Member& member);

/// Returns the number of collocation points of all plates and posts.
double solid_points(const Scene& scene);

/// Returns the line that describes plates and posts in the plan that is printed before a run.
std::string solids_line(const Scene& scene, int ranks);

/// Data of plates and posts for one row of the results.
struct SolidsRow {
  Vec3 wall_force = Vec3::Zero(), second_wall_force = Vec3::Zero();  ///< forces of the fluid on the plates
  std::vector<Vec3> post_forces;                                     ///< forces of the fluid on the posts
  Vec3 mean_velocity = Vec3::Zero();  ///< velocity averaged over the cell, including particles and posts
  double permeability = std::numeric_limits<double>::quiet_NaN();
  void add_columns(const SharedOptions& shared, Columns& to) const;
};

/// Returns the data of plates and posts for the flow `flow` around them in the ambient flow `ambient`. `particle_force`: force of the particles on
/// the fluid. `velocity_integral`: see SolidResponse::flow_integral; used only
/// if there are two plates.
SolidsRow solids_row(const SharedOptions& shared, const coupling::SolidScene& of, const stokes::AmbientFlow& ambient,
                     const coupling::PlatesAndPosts::Flow& flow, const Vec3& particle_force, const Vec3& velocity_integral);

}  // namespace tanktread
