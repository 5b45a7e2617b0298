#pragma once
// Finds the balls that contain a point.

#include <vector>

#include "base/types.hpp"

namespace tanktread::stokes {

/// Balls of different sizes in a binary tree of boxes. Finding the balls that contain a point takes a time that grows with the logarithm of the
/// number of balls.
class Vicinity {
 public:
  /// Sets n balls by centres and squared radii.
  void set_points(int n, const double* x, const double* y, const double* z, const double* square);

  /// Appends to `holding` the indices of the balls that contain the point, in no particular order. Several threads may call it.
  void list(const double* point, std::vector<int>& holding) const;

 private:
  struct Box {
    double low[3], high[3], square;  ///< low, high: bounds of the centres of the balls in this box. square: largest squared radius of these balls
    int first, last, after;          ///< first, last: range of the balls in this box. after: index of the box to test next if no ball of this box can
                                     ///< contain the point
    bool leaf;
  };
  void split(int first, int last);

  std::vector<Box> boxes_;
  std::vector<int> number_;
  std::vector<double> centre_[3], square_;
};

}  // namespace tanktread::stokes
