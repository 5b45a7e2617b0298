#pragma once
// Room for particles at the start of a run: particles must not overlap walls, posts or each other, on meshes that show this.

#include <functional>
#include <string>

#include "base/errors.hpp"
#include "scene/particle_kind.hpp"

namespace tanktread {

/// Error in the user's input: a particle overlaps a wall, a post or another particle at the start, or is closer to it than a run allows.
struct NoRoom : UserError {
  /// `distance`: distance between the two surfaces, a length; 0 or less if they overlap.
  NoRoom(const std::string& sentence, double distance) : UserError(sentence), gap(distance) {}
  double gap;
};

/// Multiplies the numbers of elements of the particle's mesh by `factor`. Does nothing to a shape from a file, which has the mesh of the file. Throws
/// UserError if the mesh would have more than 20,000 control points.
void refine(ParticleKind& kind, int factor);

/// Calls check(1), and nothing else if there is room. If it throws NoRoom, calls check(2), check(4) and check(8) to find out whether there is room on
/// finer meshes. If so, throws UserError with this remedy, otherwise the first error. `check`: function that throws NoRoom if there is no room for
/// particles whose meshes are refined by the given factor. If it throws another UserError, meshes are not refined further. `adapts`: true if the run
/// refines the meshes before its first step; it then may start if only the finer meshes keep the smallest distance that is allowed.
void check_room(const std::function<void(int factor)>& check, bool adapts = false);

}  // namespace tanktread
