#include "system/blocks/layout.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "system/blocks/tpetra.hpp"

namespace tanktread::coupling {

RowImages images_of_points(const surface::Image& reflection) {
  RowImages images;
  for (const int point : reflection.point) images.emplace_back(point, 1);
  return images;
}

Layout::Layout(std::vector<Block> blocks) : Layout(std::move(blocks), surface::Symmetry(), {}) {}

Layout::Layout(std::vector<Block> blocks, const surface::Symmetry& symmetry, const std::function<RowImages(BlockId, const surface::Image&)>& images,
               const Vec3& of_planes)
    : blocks_(std::move(blocks)), orbits_(blocks_.size()) {
  std::set<std::pair<int, std::string>> names;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& block = blocks_[k];
    if (!names.emplace(block.on, block.name).second) throw std::logic_error("two blocks of unknowns have the name " + block.name);
    if (block.parity != Parity::scalar && block.components != 3) throw std::logic_error("the block " + block.name + " must have three components");
    first_.push_back(first_.back() + block.size());
    if (symmetry.order() > 1) orbits_[k] = orbits(block, symmetry, [&](const surface::Image& g) { return images({k}, g); }, of_planes);
  }
  map_ = std::make_unique<Map>(replicated(size()));
}

Layout::~Layout() = default;

BlockId Layout::id(std::string_view name, int on) const {
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    if (blocks_[k].name == name && blocks_[k].on == on) return {k};
  throw std::logic_error("there is no block of unknowns " + std::string(name) + " on surface " + std::to_string(on));
}

Layout::Orbits Layout::orbits(const Block& block, const surface::Symmetry& symmetry, const std::function<RowImages(const surface::Image&)>& images,
                              const Vec3& of_planes) {
  std::vector<std::pair<RowImages, Eigen::RowVectorXd>> maps;  // images of the rows under each reflection, and the signs of their components
  for (const surface::Image& g : symmetry.images()) {
    const double character = surface::character(g.signs, of_planes) * (block.parity == Parity::axial ? g.signs.prod() : 1);
    maps.emplace_back(images(g), Eigen::RowVectorXd::Constant(block.components, character));
    if (block.parity != Parity::scalar) maps.back().second = character * g.signs.transpose();
    if (maps.back().first.empty()) return {};
  }
  Orbits orbits{std::vector<int>(static_cast<std::size_t>(block.rows), -1), Eigen::MatrixXd(block.rows, block.components)};
  const auto add_orbit = [&](int row) {
    if (row >= block.rows || orbits.source[static_cast<std::size_t>(row)] >= 0) return;
    const auto each = [&](const auto& act) {
      for (const auto& [images, signs] : maps) {
        const auto& [image, factor] = images[static_cast<std::size_t>(row)];
        act(image, factor * signs);
      }
    };
    Eigen::RowVectorXd kept = Eigen::RowVectorXd::Ones(block.components);  // 0 for the components that vanish on this orbit
    each([&](int image, const Eigen::RowVectorXd& signs) {
      if (image == row) kept = kept.cwiseProduct(signs.cwiseMax(0));
    });
    each([&](int image, const Eigen::RowVectorXd& signs) {
      orbits.source[static_cast<std::size_t>(image)] = row;
      orbits.factors.row(image) = kept.cwiseProduct(signs);
    });
    orbits.source[static_cast<std::size_t>(row)] = row;
    orbits.factors.row(row) = kept;
  };
  for (const int row : symmetry.fundamental()) add_orbit(row);  // preferred, so that a block of points has the fundamental rows of the symmetry
  for (int row = 0; row < block.rows; ++row) add_orbit(row);
  return orbits;
}

std::vector<std::pair<Eigen::Index, int>> Layout::independent(BlockId id) const {
  const auto& [source, factors] = orbits_[id.at];
  const Block& block = blocks_[id.at];
  std::vector<std::pair<Eigen::Index, int>> numbers;
  for (Eigen::Index row = 0; row < block.rows; ++row)
    for (Eigen::Index c = 0; c < block.components; ++c)
      if (source.empty() || (source[static_cast<std::size_t>(row)] == row && factors(row, c) != 0))
        numbers.emplace_back(first(id) + row * block.components + c,
                             source.empty() ? 1 : static_cast<int>(std::ranges::count(source, static_cast<int>(row))));
  return numbers;
}

void Layout::complete(BlockVector& vector) const {
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const auto& [source, factors] = orbits_[k];
    BlockVector::Rows rows = vector(BlockId{k});
    const auto set = [&](bool fundamental) {
      for (std::size_t i = 0; i < source.size(); ++i)
        if (const auto row = static_cast<Eigen::Index>(i); (source[i] == row) == fundamental)
          rows.row(row) = factors.row(row).cwiseProduct(rows.row(source[i]));
    };
    set(true);
    set(false);
  }
}

void Layout::project(BlockVector& vector) const {
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const auto& [source, factors] = orbits_[k];
    BlockVector::Rows rows = vector(BlockId{k});
    const Eigen::MatrixXd before = rows;
    Eigen::VectorXd members = Eigen::VectorXd::Zero(rows.rows());
    if (!source.empty()) rows.setZero();
    for (std::size_t i = 0; i < source.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      rows.row(source[i]) += factors.row(row).cwiseProduct(before.row(row));
      ++members[source[i]];
    }
    for (std::size_t i = 0; i < source.size(); ++i)
      if (source[i] == static_cast<int>(i)) rows.row(source[i]) /= members[source[i]];
  }
  complete(vector);
}

}  // namespace tanktread::coupling
