#pragma once
// A channel: outlines of one kind along a centre line.

#include <vector>

#include "surface/outline.hpp"

namespace tanktread::surface {

/// An outline times factors along x2 and x3, about the origin.
Outline scaled(const Outline& outline, const Vec2& factor);

/// The outline of a tube, times factors f2, f3 that change with the way s along a centre line. That goes along x1, in which s = x1, and may bend
/// once, by an arc in the plane x1 x2:
///
///   x = C(s) + f2(s) y2 N(s) + f3(s) y3 e3,   (y2, y3) in the outline of factor 1, N = dC/ds turned towards x2 by a right angle
class Channel {
 public:
  /// Throws UserError, one sentence with numbers, for a channel that is folded, closed or has no straight ends.
  explicit Channel(const TubeOptions& options);

  struct Section {
    Vec3 centre, along, across;  ///< C, dC/ds and N
    Vec2 factor;
  };
  Section section(double s) const;

  const Outline& outline() const { return outline_; }
  Outline outline(double s) const;      ///< of the section at s
  TubeOptions tube(double s) const;     ///< the straight tube of that section
  double start() const { return start_; }
  double end() const { return end_; }
  double smallest_radius() const { return smallest_; }  ///< half the smallest width

  /// s, y2, y3 of a place.
  Vec3 coordinates(const Vec3& x) const;
  bool inside(const Vec3& x) const;

  /// Of the wall, along: lines of a surface u = knots, from start to end, and a section at any u between them. Where f jumps in a step, u goes on and
  /// s does not.
  std::vector<double> knots(int elements) const;
  int elements() const;  ///< as many as are needed for elements as long as they are wide
  Section at(double u) const;

 private:
  struct Place {
    double s;
    Vec2 factor;
  };
  Place place(double u) const;
  Place step(double u) const;
  Section section_of(const Place& place) const;
  double parameter(double s) const;
  double jump() const;
  void find_ends();
  void check();
  void read_points();
  std::vector<double> kinks() const;
  std::vector<double> sizes(const std::vector<double>& u) const;
  std::vector<double> lines() const;

  TubeOptions options_;
  ChannelOptions own_;
  Outline outline_;
  std::optional<CubicCurve> factors_;
  double half_[2] = {1, 1}, height_ = 1;  // half widths of the outline; what a step's edges are drawn in
  double first_ = 0, last_ = 0;           // where something changes
  double start_ = 0, end_ = 0, smallest_ = 1;
};

}  // namespace tanktread::surface
