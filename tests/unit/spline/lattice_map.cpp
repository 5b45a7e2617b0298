// Tests of the symmetries of a lattice, and of meshes that keep them.

#include "spline/refinement.hpp"

#include <gtest/gtest.h>

#include "samples.hpp"
#include "sequences.hpp"
#include "spline/polar.hpp"
#include "suitability.hpp"

namespace tanktread::spline {
namespace {

/// Returns every symmetry of the lattice. Each is determined by the image of the ray.
std::vector<LatticeMap> all_maps(const Lattice& l, Ray from) {
  std::vector<LatticeMap> out;
  for (int v = 0; v < l.vertices(); ++v)
    for (int k = 0; k < l.valence(v); ++k)
      for (bool mirrored : {false, true})
        if (auto map = lattice_map(l, from, {v, k}, mirrored)) out.push_back(std::move(*map));
  return out;
}

/// Returns the symmetries that only change signs of the coordinates of positions, without the identity.
std::vector<LatticeMap> reflections(const Lattice& l, Ray from) {
  std::vector<LatticeMap> out;
  for (LatticeMap& map : all_maps(l, from)) {
    bool same = true, keeps[3] = {true, true, true}, turns[3] = {true, true, true};
    for (int v = 0; v < l.vertices(); ++v)
      for (int c = 0; c < 3; ++c) {
        const double x = l.position[std::size_t(v)][c], y = l.position[std::size_t(map.vertex[v])][c];
        keeps[c] = keeps[c] && std::abs(y - x) < 1e-12;
        turns[c] = turns[c] && std::abs(y + x) < 1e-12;
        same = same && map.vertex[v] == v;
      }
    if (!same && (keeps[0] || turns[0]) && (keeps[1] || turns[1]) && (keeps[2] || turns[2])) out.push_back(std::move(map));
  }
  return out;
}

bool has(const TMesh& mesh, const LatticeMap& map) {
  for (int v = 0; v < mesh.lattice->vertices(); ++v)
    for (int k = 0; k < mesh.lattice->valence(v); ++k) {
      const Ray to = image(*mesh.lattice, map, Ray{v, k});
      if (mesh.edge(v, k) != mesh.edge(to.vertex, to.slot)) return false;
    }
  return true;
}

bool has_all(const TMesh& mesh, const std::vector<LatticeMap>& maps) {
  return std::ranges::all_of(maps, [&](const LatticeMap& map) { return has(mesh, map); });
}

TEST(LatticeMaps, OfACubeAreItsFortyEightSymmetries) {
  const TMesh mesh = cube(3, 1);
  EXPECT_EQ(all_maps(*mesh.lattice, {mesh.lattice->extraordinary[0], 0}).size(), 48u);
  EXPECT_EQ(reflections(*mesh.lattice, {mesh.lattice->extraordinary[0], 0}).size(), 7u);
}

TEST(LatticeMaps, OfAPolarSphereRotateAboutItsAxisAndExchangeThePoles) {
  const TMesh mesh = polar(5, 4);
  EXPECT_EQ(all_maps(*mesh.lattice, {0, 0}).size(), 4u * 5u);
}

TEST(LatticeMaps, MapElementsLikeTheirCorners) {
  const TMesh mesh = cube(4, 2);
  const Lattice& l = *mesh.lattice;
  const Tiling tiling = elements(mesh);
  for (const LatticeMap& map : all_maps(l, {l.extraordinary[0], 0}))
    for (int tile : {0, 5, 17, 95}) {
      const TileImage to = image(l, map, tiling, tile);
      const auto from_corners = corners(l, tiling.tiles[tile]), to_corners = corners(l, tiling.tiles[to.tile]);
      for (int v : from_corners) EXPECT_TRUE(std::ranges::count(to_corners, map.vertex[v]) == 1);
      const auto at = std::ranges::find(to_corners, map.vertex[from_corners[0]]) - to_corners.begin();
      const bool forward = to_corners[(at + 1) % 4] == map.vertex[from_corners[1]];
      EXPECT_EQ(forward, !map.mirrored);
      EXPECT_EQ(to.exchanged, (at % 2 == 1) == forward);  // the side that begins at corner 0 is along s, at corner 1 along t
    }
}

TEST(SymmetricRefinement, KeepsTheSymmetryAndNestedSpaces) {
  for (int n : {4, 5}) {
    const TMesh base = cube(n, 3);
    SequenceOptions options;
    options.rules.images = reflections(*base.lattice, {base.lattice->extraordinary[0], 0});
    ASSERT_EQ(options.rules.images.size(), 7u);
    Findings found;
    for (unsigned seed = 0; seed < 2; ++seed) {
      run_sequence(base, seed, options, found);
      std::mt19937 generator(seed);
      TMesh mesh = base;
      for (int step = 0; step < 4; ++step) {
        mesh = refine(mesh, random_marks(mesh, 2, 1, generator), options.rules).mesh;
        EXPECT_TRUE(has_all(mesh, options.rules.images));
      }
    }
    EXPECT_EQ(found.crossings + found.overlaps + found.broken_zones + found.wrong_counts, 0);
    EXPECT_LT(found.residual, 1e-12);
  }
}

TEST(SymmetricRefinement, WithoutImagesIsNotSymmetric) {
  const TMesh base = cube(6, 3);
  const auto maps = reflections(*base.lattice, {base.lattice->extraordinary[0], 0});
  EXPECT_TRUE(has_all(base, maps));
  EXPECT_FALSE(has_all(refine(base, {{20}}).mesh, maps));
}

TEST(SymmetricRefinement, KeepsPolarMeshesSymmetric) {
  const TMesh base = polar(8, 4, 3);
  const auto maps = reflections(*base.lattice, {0, 0});
  ASSERT_EQ(maps.size(), 7u);
  RepairRules rules;
  rules.images = maps;
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937 generator(seed);
    TMesh mesh = base;
    for (int step = 0; step < 3; ++step) mesh = refine(mesh, random_marks(mesh, 2, 1, generator), rules).mesh;
    EXPECT_TRUE(has_all(mesh, maps));
    const Suitability s = suitability(mesh);
    EXPECT_EQ(s.crossings + s.overlaps, 0);
  }
}

TEST(SymmetricCoarsening, KeepsTheSymmetryOnTheWayBackToTheBaseMesh) {
  for (const TMesh& base : {cube(6, 3), polar(8, 4, 3)}) {
    RepairRules rules;
    rules.images = reflections(*base.lattice, {base.lattice->extraordinary.empty() ? 0 : base.lattice->extraordinary[0], 0});
    for (unsigned seed = 0; seed < 3; ++seed) {
      std::mt19937 generator(seed);
      TMesh mesh = base;
      for (int step = 0; step < 3; ++step) mesh = refine(mesh, random_marks(mesh, 2, 1, generator), rules).mesh;
      std::vector<Merge> some;  // every second element; lines stay if one of the images is not in this list
      for (int i = 0; i < int(elements(mesh).tiles.size()); i += 2) some.push_back({i});
      EXPECT_TRUE(has_all(coarsen(mesh, some, rules), rules.images));
      for (int round = 0; round < 8 && mesh.edges != base.edges; ++round) {
        std::vector<Merge> all;
        for (int i = 0; i < int(elements(mesh).tiles.size()); ++i) all.push_back({i, 1, 1});
        mesh = coarsen(mesh, all, rules);
        EXPECT_TRUE(has_all(mesh, rules.images));
      }
      EXPECT_EQ(mesh.edges, base.edges);
    }
  }
}

}  // namespace
}  // namespace tanktread::spline
