#pragma once
// The assembled layer operator that the Jacobian keeps frozen, row-distributed, in as few bits as a Jacobian needs.

#include <cstdint>
#include <functional>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer.hpp"

namespace tanktread::coupling {

/// Rows of a dense operator whose 3 x 3 blocks are symmetric, as those of the Stokeslet and of the stresslet are: six entries a block, each
/// rounded to 16 bits (the upper half of a float, relative error 2^-9). An operator that leaves out (dA/dx) f contracts by a tenth,
/// more or less, so the rounding cannot be seen, and a product, which is bound by memory, takes a third of the time of floats.
class FrozenOperator {
 public:
  static constexpr double bytes_a_pair = 12;  ///< of control points

  /// Rows of the own targets of a net of n points; `assemble(targets, rows)` fills three float rows a target, for a few targets at a time.
  using Assemble = std::function<void(std::span<const int> targets, stokes::Rows<float>& rows)>;
  void assemble(const std::vector<int>& targets, int n, const Assemble& assemble);

  /// Rows of the own targets of u = A f; other rows are untouched.
  void apply(const Net& f, Net& u) const;

  bool empty() const { return entries_.empty(); }

 private:
  std::vector<int> targets_;
  int n_ = 0;
  std::vector<std::uint16_t> entries_;       // [6 n target + n entry + point], entries 11, 12, 13, 22, 23, 33
  mutable std::vector<float> f1_, f2_, f3_;
};

/// u += sum over n points of the symmetric block (six arrays of n entries, one after the other) times (f1, f2, f3).
void symmetric_block_row(int n, const std::uint16_t* entries, const float* f1, const float* f2, const float* f3, float* u);

}  // namespace tanktread::coupling
