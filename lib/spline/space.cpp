#include "spline/space.hpp"

#include <algorithm>
#include <functional>
#include <string_view>
#include <unordered_map>

namespace tanktread::spline {
namespace {

std::string_view bytes(const Eigen::MatrixXd& m) {
  return {reinterpret_cast<const char*>(m.data()), static_cast<std::size_t>(m.size()) * sizeof(double)};
}

}  // namespace

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

void share_extraction(std::span<Space* const> spaces) {
  std::unordered_multimap<std::size_t, std::shared_ptr<const Eigen::MatrixXd>> kept;
  for (Space* const space : spaces)
    for (Element& e : space->elements) {
      const std::size_t hash = std::hash<std::string_view>()(bytes(*e.extraction));
      const auto [from, to] = kept.equal_range(hash);
      const auto equal = std::find_if(from, to, [&](const auto& known) {
        return known.second->rows() == e.extraction->rows() && bytes(*known.second) == bytes(*e.extraction);
      });
      if (equal == to)
        kept.emplace(hash, e.extraction);
      else
        e.extraction = equal->second;
    }
}

Block whole(const Space& space) { return {0, space.n_points, 0, static_cast<int>(space.elements.size())}; }

}  // namespace tanktread::spline
