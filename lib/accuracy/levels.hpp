#pragma once
// Settings of the levels of refinement (meshes and tolerances, from coarse to fine), as changes of a deck.

#include <map>
#include <string>
#include <vector>

namespace tanktread::accuracy {

/// Values of the keys of a deck, including defaults, as texts by the path of the key (deck::Document::values).
using Values = std::map<std::string, std::string>;

/// Levels of refinement of the three parts of the discretisation: mesh, time integration and quadrature. The three levels of a run are usually equal.
/// To measure the error of one part, two runs are compared whose levels differ only in this part.
struct Level {
  int mesh = 0, time = 0, quadrature = 0;

  bool operator==(const Level&) const = default;
};
static_assert(sizeof(Level) == 3 * sizeof(int),
              "a new part must be set in same(), balanced(), settings() and expected_error(); its share of the error is measured in ladder.cpp and "
              "used in expected_errors() and cancelled() (outcome.cpp); publication.cpp and ladder.cpp print levels");

/// Returns the level k of all parts.
constexpr Level same(int k) { return {k, k, k}; }

/// Returns the level k of all parts except `part`, which is one level looser.
constexpr Level same_but_looser(int k, int Level::* part) {
  Level level = same(k);
  --(level.*part);
  return level;
}

/// Largest level that has settings.
constexpr int last_level = 11;

/// Returns n, the number of elements per side of a cube mesh at a level: 3, 4, 5, 7, 9, 12, 16, ...
int elements_per_side(int level);

/// Returns Time/tolerance at a level, 2e-3/4^level.
double tolerance(int level);

/// Order of the errors of a mesh in the length of its elements: 4 for bicubic surfaces, a little more on coarse meshes. Fitted to 222 differences
/// between levels in 28 scenes.
constexpr double mesh_order = 4.25;

/// Returns the expected error of a level divided by the error of level 0. It is approximated by the error of the mesh, (n/n_0)^-mesh_order, with n
/// elements per side on this level and n_0 on level 0. The errors of time integration and quadrature are assumed to be small in comparison.
double expected_error(const Level& level);

/// Factors by which one level reduces the errors of time integration and of quadrature. The time tolerance limits the local error of a step and falls
/// by a factor of 4 per level; the error at a given time falls by less.
constexpr double time_ratio = 2.5, quadrature_ratio = 4;

/// Returns the Level with mesh level k whose time level and quadrature level keep the errors of time integration and quadrature small compared with
/// the mesh error. `time`, `quadrature`: these two errors at level 2, each divided by the expected error of level 2. The time level is the lowest
/// level between max(2, k - 2) and k + 2 at which the error of time integration is at most a quarter of the expected error of level k. If the error
/// is larger at all these levels, it is k + 2. The quadrature level is chosen in the same way. Levels below 2 are not used, because a request that
/// was met at level 2 could then be missed. Example: for k = 2 and the values 0.25, both levels are 2.
Level balanced(int k, double time, double quadrature);

/// Returns the settings `Section/key=value` of a level. They depend only on the deck and the level (n: elements per side of the level):
/// - `elements per side` is n. A polar mesh has 2n elements from pole to pole; the number of elements around the pole axis keeps its ratio to 2n. If
///   there are several particles, the coarsest mesh has n, and the ratios between the meshes are kept.
/// - In the section Adaptation, tolerances are multiplied by r^4 and lengths by r, where r is the deck's number of elements per side divided by n.
/// - Walls have 4n azimuthal elements if the deck has the default number, 24, and otherwise proportionally more or fewer. The number of elements
///   along them is multiplied by the same factor. If a number were below its smallest value at level 0, it is larger at all levels.
/// - `Time/tolerance` is 2e-3/4^level; a fixed step is halved per level, so that an error of second order also falls by a factor of 4.
/// - `Quadrature/tolerance` equals `Time/tolerance`, but is at least 1e-6; rules with a fixed number of points have 2 more points per level.
/// - `Steady/tolerance` is a hundredth of the larger of these two tolerances, even if the deck has a smaller value. On branches it is not raised: it
///   is lowered to a hundredth of `Time/tolerance` if the deck has a larger value.
/// - Other tolerances of solvers and searches are lowered if they are too large for these two tolerances.
std::vector<std::string> settings(const Values& deck, const Level& level);

/// Throws UserError if the deck gives an initial shape or a stress-free shape on one mesh, because every level has another mesh. Also throws
/// UserError if a Domain has plates and `Wall/elements per period`, from which the levels compute the meshes of the plates, is missing.
void check_levels(const Values& deck);

/// Returns the text `deck` of an effective deck (a deck with the values of all keys) without the section `section`.
std::string without_section(const std::string& deck, const std::string& section);

}  // namespace tanktread::accuracy
