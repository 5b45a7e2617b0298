#pragma once
// Body: the spline space, control nets and material data of a particle, built from its scene.

#include <memory>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "membrane/laws.hpp"
#include "scene/flow_plane.hpp"
#include "scene/scene.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/symmetry.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/capsule.hpp"
#include "system/parallel/ranks.hpp"
#include "system/symmetry.hpp"

namespace tanktread {

struct Member;

/// A particle on its current mesh: spline space, resting, initial and unstressed shape, and material data. The current shape is not a part of it, but
/// of motion::TimeState. The Member of the particle owns its body; an isolated rigid body is owned by its run.
///
/// make_body() sets all members; make_body_of_several() leaves `wall` null and the symmetry trivial. Later, only these change:
///   - If the mesh adapts, a new body replaces the old one. It is a copy with another `mesh`, `space` and `plain`, with the nets `rest`, `initial`
///     and `unstressed` transferred to them (for a rigid particle, fitted again), and with a larger `refit_error`.
///   - If the coupled system is built again, `symmetry` is set again.
///   - If a run resumes, `volume` is read from its checkpoint. If the mesh adapts, mesh, nets and `refit_error` are read, too, and `initial` is the
///     resting shape.
///
/// A body that represents all particles (make_stacked_body) is built together with the coupled system.
struct Body {
  spline::TMesh mesh;  ///< empty if the shape comes from a file
  spline::Space space;
  /// Space with the same control points as `space` but with degenerate poles. It is set only if the mesh may adapt and `space` removes the degeneracy
  /// of its poles by the Bezier transform; otherwise it is null.
  std::shared_ptr<const spline::Space> plain;
  Net rest;        ///< control net of the resting shape
  Net initial;     ///< control net of the shape at the start of the run
  Net unstressed;  ///< control net of the unstressed shape: the stress-free shape, shrunk by the pre-inflation
  stokes::AmbientFlow flow;
  FlowPlane plane;     ///< plane in which the Taylor parameter D and tank-treading are measured
  membrane::Law law;
  double radius = 1;   ///< R_C, radius of the sphere of equal volume
  /// Reference volume V0: volume of the resting shape, or of the initial shape if the deck requests that the particle keeps that volume. V0 is
  /// computed on the first mesh and does not change if the mesh changes.
  double volume = 0;
  double refit_error = 0;  ///< accumulated displacement of the current and the unstressed surface by mesh changes, divided by the radius R_C
  double modulus = 1;  ///< shear modulus G_s, or the surface tension sigma of an interface
  surface::Symmetry symmetry;                       ///< symmetry common to the scene and the particle at all times
  std::shared_ptr<const stokes::DuctFlow> duct;     ///< duct flow of the tube, if there is one
  std::shared_ptr<const surface::TubeWall> wall;

  /// Returns the nested space: on a refined mesh it contains the space on the coarser mesh. Fields are transferred between meshes in this space.
  const spline::Space& nested() const { return plain ? *plain : space; }
};

/// Builds the body of the only particle of a scene, with the wall of a tube and the symmetries of the scene.
Body make_body(const ParticleScene& particle_scene);

/// Builds the body of one of several particles, without the wall of a tube and without symmetries. If the member `alike` is not null, its mesh and
/// resting shape are used, and the shape is moved to the position of this particle. `empty_duct`: flow of the empty duct if another particle has it
/// already; computed if null. Throws UserError if walls leave no room for the particle (see check_room).
Body make_body_of_several(const ParticleScene& particle_scene, const Member* alike, std::shared_ptr<const stokes::DuctFlow> empty_duct);

/// Returns true if make_body_of_several() can copy the mesh and the resting shape from the particle of one scene to the particle of the other.
bool alike(const ParticleScene& one, const ParticleScene& other);

/// Sets the mesh of the body, and builds on it the spline space that the deck requests.
void lay_out(const ParticleScene& particle_scene, spline::TMesh mesh, Body& body);

/// Returns where no symmetry is searched for, such as "in a tube", or an empty string if symmetries are searched for.
std::string lacks_symmetry(const ParticleScene& particle_scene, const Body& body);

/// Returns the common symmetry of the scene, the body and the current shape x, restricted to the symmetries that the deck allows the program to use.
surface::Symmetry symmetry(const ParticleScene& particle_scene, const Body& body, const Net& x);

/// Throws NoRoom if the body does not start inside the fluid of the medium that Domain/kind chooses (see SharedOptions::medium).
void check_in_medium(const ParticleScene& particle_scene, const Body& body);

/// Loads of a particle on its current mesh, except elasticity and bending.
struct ParticleLoads {
  coupling::LoadList built_in;    ///< loads of the library
  coupling::LoadList registered;  ///< loads of `Membrane/loads`, in the order of ParticleKind::loads

  coupling::LoadList all() const;  ///< returns the built-in and the registered loads
};

/// Builds the loads of a particle. A rigid particle only has the repulsion from the wall. `wall`: wall of the tube, or null. `body` must outlive the
/// loads.
ParticleLoads make_loads(const ParticleScene& particle_scene, const Body& body, const surface::TubeWall* wall);

/// Name of the net Body::rest in checkpoints. The net Body::initial is not stored in checkpoints, despite this name.
constexpr const char* stored_rest = "initial";

/// Returns the area to which the load refers: unstressed or current. It is the current area for a drop, which has no unstressed state, and if the
/// load is computed in the strong form.
stokes::Measure load_measure(const ParticleScene& particle_scene);

/// Returns the uniform tension K (A/A0 - 1) that Membrane/global area dilatation (3.26) causes at the shape x, divided by the shear modulus or
/// surface tension of the particle; 0 without this key.
double global_tension(const ParticleScene& particle_scene, const Body& body, const Net& x);

}  // namespace tanktread
