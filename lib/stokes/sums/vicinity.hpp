#pragma once
// Which of many balls hold a point.

#include <vector>

#include "base/types.hpp"

namespace tanktread::stokes {

/// Balls of different sizes in a binary tree of boxes: to ask for those that hold a point takes a time that grows with the logarithm of
/// their number.
class Vicinity {
 public:
  /// Takes n balls: centres and squared radii.
  void place(int n, const double* x, const double* y, const double* z, const double* square);

  /// Numbers of the balls that hold the point, in no order of use.
  void list(const double* point, std::vector<int>& holding);

 private:
  struct Box {
    double low[3], high[3], square;  ///< of the centres inside; largest squared radius
    int first, last, after;          ///< its balls; the box to go on with when none of them holds the point
    bool leaf;
  };
  void split(int first, int last);

  std::vector<Box> boxes_;
  std::vector<int> number_;
  std::vector<double> centre_[3], square_;
  std::vector<char> holds_;
};

}  // namespace tanktread::stokes
