#pragma once
// Access to the Tpetra vectors that store the numbers of vectors of blocks, for solvers of Trilinos.

#include "system/blocks/block_vector.hpp"
#include "system/solvers/vectors.hpp"

namespace tanktread::coupling {

struct Layout::Map {
  Teuchos::RCP<const VectorMap> of_numbers;
};

struct BlockVector::Storage {
  Vectors vectors;  // one column
};

/// Returns the Tpetra vector of a vector that is not absent. Changes of its numbers change the vector of blocks.
inline const Vectors& tpetra_of(const BlockVector& vector) { return vector.storage()->vectors; }
inline Vectors& tpetra_of(BlockVector& vector) { return vector.storage()->vectors; }

}  // namespace tanktread::coupling
