#include "spline/space.hpp"

namespace tanktread::spline {

std::vector<Block> blocks(std::span<const Space* const> spaces) {
  std::vector<Block> all;
  Block next;
  for (const Space* space : spaces) {
    next.n_points = space->n_points, next.n_elements = static_cast<int>(space->elements.size());
    all.push_back(next);
    next.first_point += next.n_points, next.first_element += next.n_elements;
  }
  return all;
}

Space stacked(std::span<const Space* const> spaces) {
  Space all;
  const std::vector<Block> places = blocks(spaces);
  for (std::size_t p = 0; p < spaces.size(); ++p) {
    all.n_points += places[p].n_points;
    for (Element element : spaces[p]->elements) {
      for (int& point : element.points) point += places[p].first_point;
      all.elements.push_back(std::move(element));
    }
    for (std::vector<Site> sites : spaces[p]->collocation) {
      for (Site& site : sites) site.element += places[p].first_element;
      all.collocation.push_back(std::move(sites));
    }
  }
  return all;
}

Block whole(const Space& space) { return {0, space.n_points, 0, static_cast<int>(space.elements.size())}; }

}  // namespace tanktread::spline
