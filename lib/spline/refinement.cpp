#include "spline/refinement.hpp"

#include <algorithm>
#include <set>
#include <span>

#include "spline/extended_mesh.hpp"

namespace tanktread::spline {

namespace {

/// If `ray`, with which the path continues, is at a pole, extends the path through the cells of zero height there (repeated end knots) to the border
/// of the lattice.
void run_out(const Lattice& l, Ray ray, std::vector<Ray>& path) {
  while (!l.ends(ray.vertex, ray.slot) && l.length(ray.vertex, ray.slot, 1) == 0) {
    path.push_back(ray);
    ray = step(l, ray);
  }
}

/// Returns the unit edges of the line that bisects a mesh element: from bottom to top if `across_s`, otherwise from left to right.
std::vector<Ray> mid_line(const Lattice& l, const Rectangle& r, bool across_s) {
  const int cell = across_s ? l.cell_at(r.face, r.x + r.width / 2, r.y) : l.cell_at(r.face, r.x, r.y + r.height / 2);
  Ray ray = l.side(cell, 0);
  if (across_s) ray.slot = (ray.slot + 1) & 3;
  std::vector<Ray> path;
  if (across_s && !l.ends(ray.vertex, 3) && l.length(ray.vertex, 3, 1) == 0) path.push_back({ray.vertex, 3});
  for (int i = 0; i < (across_s ? r.height : r.width); ++i, ray = step(l, ray)) path.push_back(ray);
  run_out(l, ray, path);
  return path;
}

/// Returns the first part of the face extension of a T-junction, up to the first perpendicular edge.
std::vector<Ray> first_bay(const TMesh& mesh, const TJunction& t) {
  std::vector<Ray> path;
  Ray r{t.vertex, t.missing};
  do {
    path.push_back(r);
    r = step(*mesh.lattice, r);
  } while (mesh.lattice->valence(r.vertex) == 4 && !touches(mesh, r));
  run_out(*mesh.lattice, r, path);
  return path;
}

/// Returns a score for the violations after a trial insertion of the edges `bay`: the number of crossings of extensions plus half the number of
/// missing edges, both counted by ExtendedMesh. The first `rings` rings of elements around an extraordinary point must remain uniform; if the edges
/// enter them, the score includes a penalty.
double harm(ExtendedMesh& extended, const std::vector<Ray>& bay, int rings) {
  const double penalty = broken_zones(extended.mesh(), bay, rings).empty() ? 0 : 1000;
  extended.insert(bay);
  const double score = extended.crossings() + 0.5 * extended.missing() + penalty;
  extended.remove(bay);
  return score;
}

/// Compares the first parts (bays) of the face extensions of the T-junctions `candidates`, and returns the part whose insertion leaves the mesh with
/// the fewest violations, as counted by harm(). Among parts that leave equally few violations, returns the shortest. Among equally short parts,
/// returns the one that starts at the vertex of lowest index.
std::vector<Ray> best_bay(ExtendedMesh& extended, std::span<const TJunction> candidates, int rings) {
  std::vector<Ray> best;
  double least = 0;
  for (const TJunction& t : candidates) {
    auto bay = first_bay(extended.mesh(), t);
    const double score = candidates.size() > 1 ? harm(extended, bay, rings) : 0;
    const bool better = best.empty() || score < least ||
                        (score == least && (bay.size() < best.size() || (bay.size() == best.size() && t.vertex < best[0].vertex)));
    if (better) {
      best = std::move(bay);
      least = score;
    }
  }
  return best;
}

/// Inserts a path of edges and its images under the symmetries, and appends all of them to `paths`.
void insert(ExtendedMesh& extended, std::vector<Ray> path, const RepairRules& rules, std::vector<std::vector<Ray>>& paths) {
  for (const LatticeMap& map : rules.images) {
    paths.push_back(image(*extended.mesh().lattice, map, path));
    extended.insert(paths.back());
  }
  extended.insert(path);
  paths.push_back(std::move(path));
}

/// Request to bisect an element of the T-mesh by a line of constant s (`across_s`) or of constant t.
struct Cut {
  int tile;
  bool across_s;
  auto operator<=>(const Cut&) const = default;
};

/// Returns the representative of a cut (bisection of an element in one direction): the first of the cut and its images under the symmetries, in the
/// order of elements, then directions. Equivalent cuts have one representative, so that a refused bisection (the lattice is too coarse) is counted
/// only once.
Cut first_image(const Cut& cut, const Lattice& lattice, const Tiling& tiling, const std::vector<LatticeMap>& images) {
  Cut first = cut;
  for (const LatticeMap& map : images) {
    const TileImage to = image(lattice, map, tiling, cut.tile);
    first = std::min(first, Cut{to.tile, cut.across_s != to.exchanged});
  }
  return first;
}

}  // namespace

int repair(ExtendedMesh& extended, const RepairRules& rules) {
  int halvings = 0, cursor = -1;
  while (true) {
    std::vector<Ray> bay;
    if (extended.crossings() > 0) {
      const auto [a, b] = extended.crossing(cursor);
      const TJunction both[2] = {a, b};
      bay = best_bay(extended, std::span(both, a.vertex == b.vertex ? 1 : 2), rules.rings);
    } else if (extended.missing() > 0) {
      bay = best_bay(extended, extended.around_missing(), rules.rings);
    } else if (const auto overlap = extended.facing_pairs(rules.no_overlaps ? 1 : 0); !overlap.empty()) {
      bay = first_bay(extended.mesh(), overlap[0].first);
      if (auto other = first_bay(extended.mesh(), overlap[0].second); other.size() < bay.size()) bay = std::move(other);
    } else {
      return halvings;
    }
    std::vector<std::vector<Ray>> paths;
    insert(extended, std::move(bay), rules, paths);
    halvings += restore_zones(extended, std::move(paths), rules.rings);
  }
}

Refinement refine(const TMesh& mesh, const std::vector<Mark>& marks, const RepairRules& rules) {
  Refinement out;
  ExtendedMesh extended(mesh);
  if (rules.nested_extensions) extended.keep_extensions();
  const Tiling tiling = elements(mesh);
  std::set<Cut> cuts;
  for (const Mark& m : marks)
    for (bool across_s : {true, false})
      if (across_s ? m.s : m.t) cuts.insert(first_image({m.element, across_s}, *mesh.lattice, tiling, rules.images));
  std::vector<std::vector<Ray>> paths;
  for (const Cut& cut : cuts) {
    const Rectangle& r = tiling.tiles[cut.tile];
    if ((cut.across_s ? r.width : r.height) < 2)
      ++out.refused;
    else
      insert(extended, mid_line(*mesh.lattice, r, cut.across_s), rules, paths);
  }
  out.halvings = restore_zones(extended, std::move(paths), rules.rings);
  out.halvings += repair(extended, rules);
  out.mesh = std::move(extended).take();
  return out;
}

}  // namespace tanktread::spline
