#pragma once
// Settings of the levels of a ladder: meshes and tolerances, from coarse to fine, as changes of a deck.

#include <map>
#include <string>
#include <vector>

namespace tanktread::accuracy {

/// Values of all keys of a deck in effect, as text, by path (deck::Document::values).
using Values = std::map<std::string, std::string>;

/// Level of each part. The parts of a usual level are equal; a level that differs from another one in one part measures the error of this part.
struct Level {
  int mesh = 0, time = 0, quadrature = 0;

  bool operator==(const Level&) const = default;
};

/// Largest level that has settings.
constexpr int last_level = 11;

/// Returns n, the number of elements per side of a cube mesh at a level: 3, 4, 5, 7, 9, 12, 16, ...
int elements_per_side(int level);

/// Returns Time/tolerance at a level, 2e-3/4^level.
double tolerance(int level);

/// Returns the expected size of the error of a level, 1 at level 0: the geometric mean of the error of the mesh, n^-4, and of the tolerances,
/// 4^-level. A part that is looser than the mesh is assumed not to matter.
double expected_error(const Level& level);

/// Factors by which one level reduces the errors of time integration and of quadrature. The local error of a step falls by 4, the error at a time by
/// less.
constexpr double time_ratio = 2.5, quadrature_ratio = 4;

/// Returns level k with balanced parts. `time` and `quadrature`: errors of these parts at level 2, divided by the whole error there; 0.25 leaves the
/// tolerances as they are. A part is loosened by up to two levels as long as its error is at most a fourth of the expected one, and otherwise
/// tightened by up to two levels.
Level balanced(int k, double time, double quadrature);

/// Returns the settings `Section/key=value` of a level. They depend only on the deck and the level:
/// - `elements per side` is n. A polar mesh has 2n elements from pole to pole, and around the pole axis as many as the deck's ratio gives. Of several
///   particles, the ratios of their meshes are those of the deck.
/// - Tolerances and lengths of an adaptive mesh are scaled as the error of a mesh, n^-4, and the length of its elements, 1/n.
/// - Walls have 4n elements around, or in proportion as many as the deck gives.
/// - `Time/tolerance` is 2e-3/4^level; a fixed step is divided by 4^(1/2) per level, with which an error of second order falls as fast.
/// - `Quadrature/tolerance` is the same, but not below 1e-6; rules of fixed points have 2 more points per level.
/// - Tolerances of solvers and searches are kept below those of the level.
std::vector<std::string> settings(const Values& deck, const Level& level);

/// Returns the particles whose mesh is given by a file, and so is the same on every level, by path of their section.
std::vector<std::string> fixed_meshes(const Values& deck);

/// Throws UserError if the deck starts from a shape of its own mesh, which no other level has.
void check_levels(const Values& deck);

/// Returns the effective deck without this section.
std::string without_section(const std::string& deck, const std::string& section);

}  // namespace tanktread::accuracy
