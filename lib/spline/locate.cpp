#include "spline/locate.hpp"

#include <algorithm>
#include <cmath>

namespace tanktread::spline {

ParametricPoint place(const Lattice& l, int v) {
  int slot = l.cell[v][0] < 0 ? 3 : 0;
  for (int s = 1; s < l.valence(v); ++s)
    if (l.cell[v][s] >= 0 && l.cell[v][s] < l.cell[v][slot]) slot = s;
  const int c = l.cell[v][slot], k = l.corner[v][slot];
  return {l.face_of(c), double(l.x_of(c) + (k == 1 || k == 2)) / l.units, double(l.height(l.y_of(c) + (k >= 2))) / (l.rows - 2 * l.pad)};
}

ParametricPoint place(const Space& space, const Site& site) {
  const Element& e = space.elements[site.element];
  return {e.face, e.origin[0] + site.s * e.size[0], e.origin[1] + site.t * e.size[1]};
}

std::vector<int> mesh_elements(const TMesh& mesh, const Space& space) {
  const Lattice& l = *mesh.lattice;
  const Tiling tiling = elements(mesh);
  std::vector<int> out;
  for (const Element& e : space.elements) {
    const int x = int((e.origin[0] + e.size[0] / 2) * l.units), y = l.pad + int((e.origin[1] + e.size[1] / 2) * l.height(l.rows));
    out.push_back(tiling.tile_of_cell[l.cell_at(e.face, x, y)]);
  }
  return out;
}

Locator::Locator(const Space& space) : space_(space) {
  int faces = 1;
  for (const Element& e : space.elements) faces = std::max(faces, e.face + 1);
  side_ = std::max(1, int(std::sqrt(double(space.elements.size()) / faces)));
  buckets_.resize(std::size_t(faces) * side_ * side_);
  auto bucket = [&](double x) { return std::clamp(int(x * side_), 0, side_ - 1); };
  for (std::size_t k = 0; k < space.elements.size(); ++k) {
    const Element& e = space.elements[k];
    const double margin = 1e-12;
    for (int j = bucket(e.origin[1] - margin); j <= bucket(e.origin[1] + e.size[1] + margin); ++j)
      for (int i = bucket(e.origin[0] - margin); i <= bucket(e.origin[0] + e.size[0] + margin); ++i)
        buckets_[(std::size_t(e.face) * side_ + j) * side_ + i].push_back(int(k));
  }
}

Site Locator::operator()(const ParametricPoint& p) const {
  auto bucket = [&](double x) { return std::clamp(int(x * side_), 0, side_ - 1); };
  Site nearest{-1, 0, 0};
  double least = HUGE_VAL;  // smallest distance from an element, in local coordinates
  for (int k : buckets_[(std::size_t(p.face) * side_ + bucket(p.y)) * side_ + bucket(p.x)]) {
    const Element& e = space_.elements[k];
    const double s = (p.x - e.origin[0]) / e.size[0], t = (p.y - e.origin[1]) / e.size[1];
    const double outside = std::max({0.0, -s, s - 1, -t, t - 1});
    if (outside < least) {
      least = outside;
      nearest = {k, std::clamp(s, 0.0, 1.0), std::clamp(t, 0.0, 1.0)};
    }
    if (outside < 1e-12) break;
  }
  return nearest;
}

}  // namespace tanktread::spline
