#pragma once
// The assembled layer operator that the Jacobian keeps frozen, row-distributed, in as few bits as a Jacobian needs.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "system/particle.hpp"

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

/// A layer operator A assembled for the shape x0 serves a later shape x that is x0 rotated and a little deformed: with the rotation Q_p of each
/// particle p that fits its control points best (least squares; Kabsch 1976),
///
///   (A f)_p ~ Q_p sum_q A_pq Q_q^T f_q                                                                                            (4.29)
///
/// This is exact if all particles turn together. Control points of a tank-treading membrane are carried around while the shape stays, which changes
/// the operator by this rotation only.
class Corotation {
 public:
  Corotation() = default;

  /// The rotations that take `from` to `to`, control nets of shape (N, 3). `particles`: the rows of each.
  Corotation(std::span<const Particle> particles, const Net& from, const Net& to);

  Net back(const Net& f) const;    ///< Q^T f
  Net forth(const Net& f) const;  ///< Q f

  /// Returns the displacement to - from less the rigid motion of each particle that fits it best.
  static Net deformation(std::span<const Particle> particles, const Net& from, const Net& to);

 private:
  Net rotated(Net f, bool back) const;

  std::vector<spline::Block> blocks_;
  std::vector<Mat3> rotations_;
};

}  // namespace tanktread::coupling
