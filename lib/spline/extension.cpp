#include "spline/extension.hpp"

namespace tanktread::spline {

namespace {
std::vector<Ray> bays(const TMesh& mesh, Ray ray, int count) {
  std::vector<Ray> path;
  while (count > 0 && !mesh.lattice->ends(ray.vertex, ray.slot)) {
    path.push_back(ray);
    ray = step(*mesh.lattice, ray);
    if (mesh.lattice->valence(ray.vertex) == 3) break;
    if (touches(mesh, ray)) --count;
  }
  return path;
}
}  // namespace

int missing_slot(const TMesh& mesh, int v) {
  constexpr std::int8_t missing[16] = {-1, -1, -1, -1, -1, -1, -1, 3, -1, -1, -1, 2, -1, 1, 0, -1};
  const int m = mesh.lattice->valence(v) == 4 ? missing[mesh.edges[v]] : -1;
  return m >= 0 && !mesh.lattice->ends(v, m) ? m : -1;
}

std::vector<TJunction> t_junctions(const TMesh& mesh) {
  std::vector<TJunction> out;
  for (int v = 0; v < mesh.lattice->vertices(); ++v)
    if (const int m = missing_slot(mesh, v); m >= 0) out.push_back({v, m});
  return out;
}

std::vector<Ray> face_extension(const TMesh& mesh, const TJunction& t) { return bays(mesh, {t.vertex, t.missing}, 2); }
std::vector<Ray> edge_extension(const TMesh& mesh, const TJunction& t) { return bays(mesh, {t.vertex, (t.missing + 2) & 3}, 1); }

}  // namespace tanktread::spline
