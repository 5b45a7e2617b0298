#include "stokes/sums/vicinity.hpp"

#include <algorithm>

#include "base/indices.hpp"
#include "stokes/kernels/panel_kernel.hpp"

namespace tanktread::stokes {
namespace {

/// Maximum number of balls in a leaf. The balls of a leaf are tested one by one. With smaller leaves, testing the boxes of the tree would cost as
/// much as testing the balls.
constexpr int leaf = 64;

}  // namespace

void Vicinity::set_points(int n, const double* x, const double* y, const double* z, const double* square) {
  const double* const at[3] = {x, y, z};
  number_ = indices(n);
  boxes_.clear();
  for (int c = 0; c < 3; ++c) centre_[c].assign(at[c], at[c] + n);
  square_.assign(square, square + n);
  split(0, n);
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < n; ++k) centre_[c][k] = at[c][number_[k]];
  for (int k = 0; k < n; ++k) square_[k] = square[number_[k]];
}

/// Appends to the tree a box for the balls number_[first] .. number_[last - 1], and its descendants. Reorders these entries of number_. During this
/// call, centre_ and square_ are still in the order of the arguments of set_points().
void Vicinity::split(int first, int last) {
  Box box{{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0, first, last, 0, last - first <= leaf};
  for (int k = first; k < last; ++k) {
    for (int c = 0; c < 3; ++c) {
      box.low[c] = std::min(box.low[c], centre_[c][number_[k]]);
      box.high[c] = std::max(box.high[c], centre_[c][number_[k]]);
    }
    box.square = std::max(box.square, square_[number_[k]]);
  }
  const auto at = boxes_.size();
  boxes_.push_back(box);
  if (!box.leaf) {
    int longest = 0;
    for (int c = 1; c < 3; ++c)
      if (box.high[c] - box.low[c] > box.high[longest] - box.low[longest]) longest = c;
    const int middle = first + (last - first) / 2;
    std::nth_element(number_.begin() + first, number_.begin() + middle, number_.begin() + last,
                     [&](int a, int b) { return centre_[longest][a] < centre_[longest][b]; });
    split(first, middle);
    split(middle, last);
  }
  boxes_[at].after = static_cast<int>(boxes_.size());
}

void Vicinity::list(const double* point, std::vector<int>& holding) const {
  char holds[leaf];
  for (std::size_t b = 0; b < boxes_.size();) {
    const Box& box = boxes_[b];
    double square = 0;
    for (int c = 0; c < 3; ++c) {
      const double beyond = std::max({0., box.low[c] - point[c], point[c] - box.high[c]});
      square += beyond * beyond;
    }
    const bool near = square < box.square;
    if (near && box.leaf) {
      const int n = box.last - box.first;
      mark_within(n, &centre_[0][box.first], &centre_[1][box.first], &centre_[2][box.first], &square_[box.first], point, holds);
      for (int k = 0; k < n; ++k)
        if (holds[k]) holding.push_back(number_[box.first + k]);
    }
    b = near ? b + 1 : static_cast<std::size_t>(box.after);
  }
}

}  // namespace tanktread::stokes
