#pragma once
// Member: one particle of a run that may have several.

#include <memory>
#include <string>
#include <vector>

#include "scene/body.hpp"
#include "scene/scene.hpp"
#include "scene/series/phase_angle.hpp"
#include "membrane/membrane.hpp"
#include "record/files/checkpoint.hpp"
#include "spline/locate.hpp"
#include "spline/space.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

/// One particle of a run: its own scene, its body, and its rows in the nets of all particles.
struct Member {
  std::string name;  ///< empty if it is the only particle
  ParticleScene scene;
  std::unique_ptr<Body> body;
  spline::Block block;
  /// Geometry and membrane. Members with equal spaces share the geometry; if also their materials and unstressed shapes are equal, they share the
  /// membrane. A single member uses the geometry and membrane of the coupled system and shares the ownership of this system; both pointers are null
  /// before the system is built.
  std::shared_ptr<const surface::Geometry> geometry;
  std::shared_ptr<const membrane::Membrane> membrane;
  ParticleLoads loads;  ///< loads that the coupled system includes; set when the system is built
  /// initial mass of the surfactant (integral of the concentration over the surface) on the first mesh; 0 without surfactant. Set when a run starts
  /// or resumes
  double surfactant_mass = 0;
  /// parametric point of the material point whose phase angle is recorded. The parametric point does not change if the mesh adapts
  spline::ParametricPoint place;
  spline::Site followed;  ///< site (element and parameters) of the followed material point on the current mesh
  PhaseAngle phase_angle;

  Net own(const Net& of_all) const { return block.rows(of_all); }
  /// Returns the name under which the item `what` of this particle is stored or reported, for example `red: mesh`.
  std::string label(const std::string& what) const { return name.empty() ? what : name + ": " + what; }
  /// Returns the name of the column `what` of this particle in the results.
  std::string column(const std::string& what) const { return name.empty() ? what : name + "/" + what; }
};

/// Returns what drives a rigid body: the prescribed motion, or the force (including the weight) and the torque.
coupling::RigidDrive drive_of(const ParticleScene& particle_scene, const Body& body);

/// Builds all particles of a scene, each in its unstressed, resting and initial shape.
std::vector<Member> make_members(const Scene& scene);

/// If the mesh may adapt, sets `followed` to the site of the parametric point `place` on the current mesh. `place` does not change, so a resumed run
/// finds the same site.
void follow(Member& member);

/// Sets the blocks (rows in the nets of all particles) of all members and, if there are several, their geometries and membranes;
/// their bodies then have no symmetry. The bodies must exist.
void arrange(std::vector<Member>& members);

/// Returns one body that represents all members: its nets are the stacked nets of the members, its radius is the largest R_C, and its volume is the
/// total volume. Returns null if there is only one member. Its mesh and `plain` are not set, the wall of a tube is added later, and quantities
/// of the membrane are copied from the first member.
std::unique_ptr<Body> make_stacked_body(const std::vector<Member>& members);

/// Builds the coupled system of all members, with the given tube or solids (plates and posts) if there are any. Only the operators that the members
/// need are built. `all`: body of all members (see make_stacked_body). Sets the loads of the members. If there is a single member, its geometry
/// and membrane become the geometry and membrane of the system.
std::shared_ptr<coupling::Capsule> make_capsule(std::vector<Member>& members, const Body& all, Phases& phases, std::unique_ptr<coupling::Tube> tube,
                                                const std::optional<coupling::SolidScene>& solids);

/// Returns the particles in the shape x with the fluid velocity v, as user-defined series receive them. Empty if the deck asks for no such series.
std::vector<RecordedParticle> recorded_particles(const std::vector<Member>& members, const Net& x, const Net& v);

/// Writes to a checkpoint, or reads from it, the data of the members in addition to the state: volumes, nets and adapted meshes. Throws
/// std::out_of_range if the checkpoint lacks a part of these data.
void store(const std::vector<Member>& members, output::Checkpoint& checkpoint);
bool restore(const output::Checkpoint& checkpoint, std::vector<Member>& members);  ///< returns true if the mesh of any member was read

/// Returns the mesh with the edges stored in the checkpoint, on the lattice of possible edges of `mesh`. Throws UserError if the stored mesh has
/// another lattice.
spline::TMesh stored_mesh(spline::TMesh mesh, const output::Checkpoint& checkpoint, const std::string& prefix = {});

}  // namespace tanktread
