#pragma once
// A scene made into spaces, nets and a coupled system.

#include <memory>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "membrane/laws.hpp"
#include "scene/flow_plane.hpp"
#include "scene/scene.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/symmetry.hpp"
#include "surface/tube_wall.hpp"
#include "system/capsule.hpp"
#include "system/ranks.hpp"
#include "system/symmetry.hpp"

namespace tanktread {

struct Member;

/// What the deck describes, before anything moves.
struct Body {
  spline::TMesh mesh;  ///< empty for one from a file
  spline::Space space;
  std::shared_ptr<const spline::Space> plain;  ///< with the same control points and poles as they are, for poles by the Bezier transform
  Net rest;        ///< control net of the resting shape
  Net initial;     ///< of the shape that the run starts with
  Net unstressed;  ///< smaller by the pre-inflation
  stokes::AmbientFlow flow;
  FlowPlane plane;     ///< that D and tank-treading are measured in
  membrane::Law law;
  double radius = 1;   ///< R_C
  double volume = 0;   ///< V0, of the resting shape, or the initial one, on the first mesh, whatever mesh the run goes on with
  double initial_area = 0;  ///< int c dG of a surfactant at the start of the run, on the first mesh; 0 until it is known
  double refit_error = 0;  ///< sum of what changes of the mesh have moved the present and the unstressed surface by, over R_C
  double modulus = 1;  ///< G_s, or sigma of an interface
  surface::Symmetry symmetry;                       ///< of all this, and of the shapes that it takes
  std::shared_ptr<const stokes::DuctFlow> duct;     ///< of the tube, if there is one
  std::shared_ptr<const surface::TubeWall> wall;

  /// The space whose refinements contain it: fields go over from mesh to mesh in it.
  const spline::Space& nested() const { return plain ? *plain : space; }
};

/// Of a scene of one particle. `alike`: an equal particle elsewhere, or none, whose mesh and resting shape are taken.
Body body(const Scene& scene, const Member* alike = nullptr);

/// Whether a particle's mesh and resting shape can be had from one of the other scene.
bool alike(const Scene& one, const Scene& other);

/// Gives the body a mesh, and the spline space that the deck wants on it.
void lay_out(const Scene& scene, spline::TMesh mesh, Body& body);

/// The symmetry of the scene, as far as the deck wants it to be used, and of the shape x that the particle has by now.
surface::Symmetry symmetry(const Scene& scene, const Body& body, const Net& x);

/// Makes the loads of a particle, in addition to elasticity and bending, on its present mesh; of a rigid one only the repulsion. `wall`: of its tube,
/// or null.
coupling::LoadList loads(const Scene& scene, const Body& body, const surface::TubeWall* wall);

/// What the load is measured on: that of a drop, which has no unstressed state, and the strong one are always per current area.
stokes::Measure load_measure(const Scene& scene);

}  // namespace tanktread
