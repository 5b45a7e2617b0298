#include "system/frozen/frozen_operator.hpp"

#include <algorithm>
#include <bit>

#include "base/threads.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the upper 16 bits of a float, rounded to nearest.
std::uint16_t narrowed(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  return static_cast<std::uint16_t>((bits + 0x7fff + (bits >> 16 & 1)) >> 16);
}

}  // namespace

void FrozenOperator::assemble(const std::vector<int>& targets, int n, const Assemble& assemble, double unit) {
  constexpr size_t at_a_time = 64;
  targets_ = targets;
  n_ = n;
  unit_ = unit;
  const auto half = static_cast<float>(0.5 / unit);
  entries_.resize(6 * static_cast<size_t>(n) * targets.size());
  stokes::Rows<float> rows;
  stop_together([&] {
    for (size_t first = 0; first < targets.size(); first += at_a_time) {
      const std::span<const int> some(targets.data() + first, std::min(at_a_time, targets.size() - first));
      assemble(some, rows);
      each_item(some.size(), [&](size_t k) {
        std::uint16_t* out = entries_.data() + 6 * static_cast<size_t>(n) * (first + k);
        const auto first_row = 3 * static_cast<Eigen::Index>(k);
        for (int i = 0; i < 3; ++i)
          for (int j = i; j < 3; ++j, out += n)
            for (int b = 0; b < n; ++b) out[b] = narrowed(half * (rows(first_row + i, 3 * b + j) + rows(first_row + j, 3 * b + i)));
      });
    }
  });
}

void FrozenOperator::apply(const Net& f, Net& u) const {
  const Eigen::Matrix<double, Eigen::Dynamic, 3> by_component = f;
  constexpr size_t targets_at_a_time = 8;
  each_block(targets_.size(), targets_at_a_time, [&](size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      double sum[3] = {0, 0, 0};
      symmetric_block_row(n_, entries_.data() + 6 * static_cast<size_t>(n_) * k, by_component.col(0).data(), by_component.col(1).data(),
                          by_component.col(2).data(), sum);
      u.row(targets_[k]) << unit_ * sum[0], unit_ * sum[1], unit_ * sum[2];
    }
  });
}

}  // namespace tanktread::coupling
