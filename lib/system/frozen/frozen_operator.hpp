#pragma once
// Dense layer operator of the Jacobian, kept from an earlier shape (frozen). Its rows are divided among the ranks and stored in reduced precision.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer.hpp"

namespace tanktread::coupling {

/// Rows of a dense operator whose 3 x 3 blocks are symmetric, such as the Stokeslet and the stresslet in free space. Of other blocks, such as those
/// with images in a wall, only the symmetric part is kept. Each block has six entries, each rounded to 16 bits (the upper half of a float, relative
/// error 2^-9). The rounding hardly affects the convergence of the quasi-Newton iteration. This iteration omits (dA/dx) f, and therefore reduces its
/// error only by a factor of about ten per iteration, even without rounding. Vectors are in double precision. With float vectors, runs on different
/// numbers of ranks would differ by 1e-10 instead of 1e-16, because each iteration of GMRES enlarges the differences.
class FrozenOperator {
 public:
  static constexpr double bytes_a_pair = 12;  ///< bytes per pair of control points

  /// Function that computes the rows of the operator for these targets: three rows per target and three columns per control point, in float.
  /// assemble() calls it several times, each time for a few of the rank-owned `targets`. `n`: number of control points. `unit`: entries are
  /// divided by it before they are rounded. For a single layer it should be a length of the scene, so that rounding does not depend on the units of
  /// the deck.
  using Assemble = std::function<void(std::span<const int> targets, stokes::Rows<float>& rows)>;
  void assemble(const std::vector<int>& targets, int n, const Assemble& assemble, double unit = 1);

  /// Computes the rows of u = A f at the rank-owned targets; other rows are unchanged.
  void apply(const Net& f, Net& u) const;

 private:
  std::vector<int> targets_;
  int n_ = 0;
  double unit_ = 1;
  std::vector<std::uint16_t> entries_;       // six entries (11, 12, 13, 22, 23, 33) of each symmetric 3 x 3 block. Entry e = 0 .. 5 of the block for
                                             // row `target` and control point p of n is at (6 target + e) n + p
};

/// Adds to u[0 .. 2] the sum over n points p of the symmetric 3 x 3 block of p times the vector (f1[p], f2[p], f3[p]). `entries`: six consecutive
/// arrays of n entries, the entries 11, 12, 13, 22, 23, 33 of all blocks.
void symmetric_block_row(int n, const std::uint16_t* entries, const double* f1, const double* f2, const double* f3, double* u);

}  // namespace tanktread::coupling
