#pragma once
// Violations of the conditions for linearly independent and nested splines on a T-mesh, counted from scratch.

#include "spline/extended_mesh.hpp"

namespace tanktread::spline {

struct Suitability {
  int crossings = 0, overlaps = 0;
  int broken_zones = 0;  ///< edges off the h lattice within three rings of an extraordinary point
};

inline Suitability suitability(const TMesh& mesh) {
  const ExtendedMesh extended(mesh);
  Suitability s;
  s.crossings = extended.crossings();
  s.overlaps = extended.overlaps();
  for (int v = 0; v < mesh.lattice->vertices(); ++v)
    for (int k = 0; k < mesh.lattice->valence(v); ++k)
      if (mesh.edge(v, k) && !broken_zones(mesh, {{v, k}}, 3).empty()) ++s.broken_zones;
  return s;
}

}  // namespace tanktread::spline
