#include "surface/fundamental.hpp"

#include <algorithm>

namespace tanktread::surface {

bool FundamentalElements::whole() const {
  return std::ranges::all_of(weight, [](double w) { return w == 1; });
}

FundamentalElements fundamental_elements(const Symmetry& symmetry, int n_elements, const std::function<std::span<const int>(int)>& points) {
  FundamentalElements result;
  const auto inside = [&](int e) { return std::ranges::count_if(points(e), [&](int a) { return symmetry.source()[a] == a; }); };
  for (int e = 0; e < n_elements; ++e) {
    int same = 1, best = e;
    for (const Image& g : symmetry.images()) {
      const int other = g.element[e];
      same += other == e;
      if (const auto n = inside(other), most = inside(best); n > most || (n == most && other < best)) best = other;
    }
    if (best != e) continue;
    result.element.push_back(e);
    result.weight.push_back(1. / same);
  }
  return result;
}

/// What an element adds at p, its image g adds, reflected, at g p; and as many images of p are its source as leave that in place.
void fold(const Symmetry& symmetry, Net& sums) {
  if (symmetry.order() == 1) return;
  const std::vector<int>& source = symmetry.source();
  std::vector<int> images(source.size(), 0);
  for (const int a : source) ++images[a];
  const auto added = [&](int p) -> Eigen::RowVector3d {
    return symmetry.order() / images[source[p]] * symmetry.signs().row(p).cwiseProduct(sums.row(p));
  };
  for (const int a : symmetry.fundamental()) sums.row(a) = added(a);
  for (int p = 0; p < static_cast<int>(source.size()); ++p)
    if (source[p] != p) sums.row(source[p]) += added(p);
}

}  // namespace tanktread::surface
