#include "spline/extraordinary_zone.hpp"

#include <algorithm>

namespace tanktread::spline {

std::vector<int> broken_zones(const TMesh& mesh, const std::vector<Ray>& path, int rings) {
  const Lattice& l = *mesh.lattice;
  std::vector<int> out;
  if (l.extraordinary.empty()) return out;
  for (Ray e : path) {
    const int c = l.cell[e.vertex][e.slot], k = l.corner[e.vertex][e.slot], face = l.face_of(c);
    // The unit edge from (x, y) to (x + dx, y + dy) of the face, on the line with this number.
    const int x = l.x_of(c) + (k == 1), y = l.y_of(c) + (k == 2), dx = k % 2 == 0, dy = 1 - dx, line = dx ? y : x;
    for (int corner = 0; corner < 4; ++corner) {
      const int point = l.point_at[face][corner];
      if (point < 0) continue;
      const int h = mesh.spacing[point];
      if (line % h == 0) continue;
      const bool right = corner == 1 || corner == 2, top = corner >= 2;
      auto distance = [&](int i, int j) { return std::max(right ? l.units - i : i, top ? l.units - j : j); };
      if (std::min(distance(x, y), distance(x + dx, y + dy)) < rings * h && std::find(out.begin(), out.end(), point) == out.end())
        out.push_back(point);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::vector<Ray>> two_ring_cuts(const TMesh& mesh, int point) {
  const Lattice& l = *mesh.lattice;
  const int P = l.extraordinary[point], h = mesh.spacing[point];
  std::vector<std::vector<Ray>> out;
  for (int s = 0; s < 3; ++s)
    for (int at : {h / 2, 3 * h / 2})
      for (int turn : {1, 3}) {  // into the sectors on both sides of the spoke
        Ray r{P, s};
        for (int i = 0; i < at; ++i) r = step(l, r);
        r.slot = (r.slot + turn) & 3;
        std::vector<Ray> path;
        for (int i = 0; i < 2 * h; ++i, r = step(l, r)) path.push_back(r);
        out.push_back(std::move(path));
      }
  return out;
}

int restore_zones(ExtendedMesh& extended, std::vector<std::vector<Ray>> paths, int rings) {
  int halvings = 0;
  while (!paths.empty()) {
    const auto path = std::move(paths.back());
    paths.pop_back();
    for (auto broken = broken_zones(extended.mesh(), path, rings); !broken.empty(); broken = broken_zones(extended.mesh(), path, rings))
      for (int point : broken) {
        for (auto& cut : two_ring_cuts(extended.mesh(), point)) {
          extended.insert(cut);
          paths.push_back(std::move(cut));
        }
        extended.set_spacing(point, extended.mesh().spacing[point] / 2);
        ++halvings;
      }
  }
  return halvings;
}

}  // namespace tanktread::spline
