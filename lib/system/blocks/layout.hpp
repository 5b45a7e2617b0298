#pragma once
// Addresses of the unknowns of a system: named blocks of numbers, one after another, and their symmetry.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::coupling {

/// How a reflection maps the rows of a block: as vectors (velocities), as axial vectors (angular velocities), or as separate numbers.
enum class Parity { polar, axial, scalar };

/// A block of unknowns: a matrix with one row per control point, site or coefficient.
struct Block {
  std::string name;
  int on = -1;              ///< index of the particle; -1: all other unknowns, also those of a wall
  Eigen::Index rows = 0;
  int components = 3;
  Parity parity = Parity::polar;
  /// The stored numbers are values divided by this unit, which makes unknowns comparable and weighs them in norms.
  double unit = 1;

  Eigen::Index size() const { return rows * components; }
  bool operator==(const Block&) const = default;
};

/// Index of a block in its layout.
struct BlockId {
  std::size_t at = 0;
};

/// Image of each row of a block under a reflection, and a factor by which the reflection multiplies the row in addition to the signs of its parity.
using RowImages = std::vector<std::pair<int, double>>;

/// Returns the images of the rows of a block with one row per control point.
RowImages images_of_points(const surface::Image& reflection);

class BlockVector;

/// Blocks of unknowns, stored one after another and row by row. Immutable; vectors share it (BlockVector). The blocks contain all rows, not only the
/// rows of fundamental points.
class Layout {
 public:
  /// Creates a layout without symmetry. Throws std::logic_error if two blocks on one surface have the same name, or if a block of vectors has another
  /// number of components than three.
  explicit Layout(std::vector<Block> blocks);

  /// `images` returns the images of the rows of a block under a reflection of `symmetry`; if the result is empty, the block has no symmetry.
  /// `of_planes`: factors of the parity of all blocks, see surface::Parity; symmetric vectors have (1, 1, 1).
  Layout(std::vector<Block> blocks, const surface::Symmetry& symmetry, const std::function<RowImages(BlockId, const surface::Image&)>& images,
         const Vec3& of_planes = Vec3::Ones());
  ~Layout();

  const std::vector<Block>& blocks() const { return blocks_; }
  const Block& operator[](BlockId id) const { return blocks_[id.at]; }
  BlockId id(std::string_view name, int on) const;                ///< throws std::logic_error if there is no such block
  Eigen::Index first(BlockId id) const { return first_[id.at]; }  ///< index of the first number of the block among all numbers
  Eigen::Index size() const { return first_.back(); }             ///< number of all numbers

  /// Returns the numbers of a block from which complete() sets the block: their indices among all numbers, and the numbers of rows of their orbits.
  std::vector<std::pair<Eigen::Index, int>> independent(BlockId id) const;

  /// Sets all rows from one row per symmetry orbit, the fundamental row. A component becomes zero in a row that a reflection maps onto itself while
  /// it changes the sign of the component.
  void complete(BlockVector& vector) const;
  /// Replaces the rows of each orbit by their mean, after the reflections have mapped them onto each other. Removes asymmetric round-off.
  void project(BlockVector& vector) const;

 private:
  friend class BlockVector;
  struct Map;  // map of the Tpetra vectors
  struct Orbits {
    std::vector<int> source;   // for each row, the fundamental row of its orbit; empty if the block has no symmetry
    Eigen::MatrixXd factors;   // shape (rows, components): factors that convert the source of a row to the row: 1, -1 or 0
  };
  static Orbits orbits(const Block& block, const surface::Symmetry& symmetry, const std::function<RowImages(const surface::Image&)>& images,
                       const Vec3& of_planes);

  std::vector<Block> blocks_;
  std::vector<Eigen::Index> first_{0};  // of each block, and the number of all numbers
  std::vector<Orbits> orbits_;
  std::unique_ptr<const Map> map_;
};

}  // namespace tanktread::coupling
