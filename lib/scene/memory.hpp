#pragma once
// Limits of memory. They are checked before a run allocates anything.

namespace tanktread {

struct ParticleScene;
struct Scene;

/// Throws UserError if the operators assembled for the particle or for the wall of its duct, or the vectors of an iterative solver, take more memory
/// than the program allows. `particle_scene`: scene with one particle.
void check_memory(const ParticleScene& particle_scene);

/// Throws UserError if the scene has no rigid bodies, whose tractions are the unknowns of the first-kind equation (2.40), or if the matrix of this
/// equation is too large.
void check_first_kind(const Scene& scene);

/// Throws UserError if the operator of the tractions on plates and posts is too large. Plates alone are inverted by Fourier series.
void check_posts_memory(const Scene& scene);

/// Returns the largest number of control points that the wall of a tube may have. Each rank stores the factors of the wall, and the factors of all
/// ranks together must fit into the allowed memory.
double most_wall_points();

}  // namespace tanktread
