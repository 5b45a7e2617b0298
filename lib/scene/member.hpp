#pragma once
// One particle of a run among the others.

#include <memory>
#include <string>
#include <vector>

#include "scene/body.hpp"
#include "scene/scene.hpp"
#include "scene/series/run_totals.hpp"
#include "scene/particles/warnings.hpp"
#include "membrane/membrane.hpp"
#include "record/files/checkpoint.hpp"
#include "spline/locate.hpp"
#include "spline/space.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

/// A particle: its scene as if it were alone, what that makes, and its rows of the nets of all.
struct Member {
  std::string name;  ///< empty: it is the only one
  Scene scene;
  std::unique_ptr<Body> body;
  spline::Block block;
  std::shared_ptr<const surface::Geometry> geometry;  ///< this and the next are one of all members that are equal
  std::shared_ptr<const membrane::Membrane> membrane;
  spline::Place place;    ///< of the material point whose phase is told, in the nested space
  spline::Site followed;  ///< the same on the present mesh
  PhaseAngle phase_angle;

  Net own(const Net& of_all) const { return block.rows(of_all); }
  std::string label(const std::string& what) const { return name.empty() ? what : name + ": " + what; }   ///< in checkpoints and sentences
  std::string spoken() const { return name.empty() ? "Particle" : "Particles/" + name; }                ///< in sentences, as its section is called
  std::string column(const std::string& what) const { return name.empty() ? what : name + "/" + what; }  ///< in the record
};

/// What drives a rigid body; its weight is a force.
coupling::Rigid rigid(const Scene& scene, const Body& body);

/// All particles of a scene in their resting shapes.
std::vector<Member> members(const Scene& scene);

/// Finds the followed point on a mesh that may adapt, before and after a resume in one way.
void follow(Member& member);

/// Blocks, geometries and membranes of members whose bodies are there.
void arrange(std::vector<Member>& members);

/// All of them as one body: its nets are stacked, its measures those of the whole. Of one particle nothing is copied: then there is none.
std::unique_ptr<Body> stacked_body(const std::vector<Member>& members);

/// The coupled system that they need, and no more, in a tube if there is one. `all`: their space and nets.
std::unique_ptr<coupling::Capsule> capsule(const std::vector<Member>& members, const Body& all, coupling::Ranks& ranks, Phases& phases,
                                           std::unique_ptr<coupling::Tube> tube);

/// Returns the particles as registered series see them at x, where the fluids move by v; none if the deck asks for no such series.
std::vector<RecordedParticle> recorded_particles(const std::vector<Member>& members, const Net& x, const Net& v);

/// What a checkpoint holds of them beside the state, and the bodies on the meshes that it holds. Throws std::out_of_range where it lacks a part.
void store(const std::vector<Member>& members, output::Checkpoint& checkpoint);
bool restore(const output::Checkpoint& checkpoint, std::vector<Member>& members);  ///< whether any has another mesh now

/// The mesh whose edges a checkpoint holds, on the lattice of `mesh`. Throws UserError where that is another one.
spline::TMesh stored_mesh(spline::TMesh mesh, const output::Checkpoint& checkpoint, const std::string& prefix = {});

}  // namespace tanktread
