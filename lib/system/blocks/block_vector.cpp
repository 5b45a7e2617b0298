#include "system/blocks/block_vector.hpp"

#include <utility>

#include "system/blocks/tpetra.hpp"

namespace tanktread::coupling {

BlockVector::BlockVector() = default;

BlockVector::BlockVector(std::shared_ptr<const Layout> layout)
    : layout_(std::move(layout)), storage_(layout_ ? new Storage{Vectors(layout_->map_->of_numbers, 1)} : nullptr),
      numbers_(layout_ ? storage_->vectors.getDataNonConst(0).getRawPtr() : nullptr) {}

BlockVector::BlockVector(const BlockVector& other) : BlockVector(other.layout_) { numbers() = other.numbers(); }

BlockVector::BlockVector(BlockVector&& other) noexcept : BlockVector() { swap(other); }

BlockVector& BlockVector::operator=(BlockVector other) noexcept {
  swap(other);
  return *this;
}

BlockVector::~BlockVector() = default;

void BlockVector::swap(BlockVector& other) noexcept {
  std::swap(layout_, other.layout_);
  std::swap(storage_, other.storage_);
  std::swap(numbers_, other.numbers_);
}

}  // namespace tanktread::coupling
