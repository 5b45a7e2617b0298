#pragma once
// A channel: a cross-section that is scaled along a centre line.

#include <vector>

#include "surface/walls/outline.hpp"

namespace tanktread::surface {

/// Returns an outline scaled about the origin by the two factors along x2 and x3.
Outline scaled(const Outline& outline, const Vec2& factor);

/// Channel whose cross-section is the outline of a tube, scaled by factors f2 and f3 that depend on the arc length s of a centre line. The centre
/// line runs along x1, where s = x1, and may bend once, by a circular arc in the plane x1 x2:
///
///   x = C(s) + f2(s) y2 N(s) + f3(s) y3 e3,   (y2, y3) in the unscaled outline, N = dC/ds turned towards x2 by a right angle
///
/// A periodic channel with period L has no bend, and its factors satisfy f(s + L) = f(s). start() and end() are then the ends of the modelled period,
/// which is centred on the range of s in which the factors change.
class Channel {
 public:
  /// Throws UserError, whose message states the values, if the channel is folded (cross-sections intersect), closed (a width is not above 0.02 R_T,
  /// with R_T the tube radius) or has no straight ends.
  explicit Channel(const TubeOptions& options);

  struct Section {
    Vec3 centre, along, normal;  ///< C, dC/ds and N
    Vec2 factor;
  };
  Section section(double s) const;

  const Outline& outline() const { return outline_; }
  Outline outline(double s) const;  ///< outline of the cross-section at the arc length s of the centre line
  /// Returns the options of a straight tube with the cross-section at the arc length s of the centre line. The cross-section `file` is not scaled,
  /// because its flow is computed from outline(s).
  TubeOptions tube(double s) const;
  double start() const { return start_; }
  double end() const { return end_; }
  bool repeats() const { return options_.period > 0; }
  double smallest_radius() const { return smallest_; }  ///< half the smallest width of the channel

  /// Returns, for the position x, the arc length s of the centre line and the coordinates y2, y3 in the unscaled cross-section.
  Vec3 coordinates(const Vec3& x) const;
  bool inside(const Vec3& x) const;

  /// Returns the knots, in the longitudinal parameter u, of a spline surface for the wall from start() to end(). at() returns the cross-section at
  /// any u in this range. At a step, the scale factors f2 and f3 change with u while the arc length s is constant.
  std::vector<double> knots(int elements) const;
  int elements() const;  ///< number of elements along the wall: Channel/axial elements or, if not given, such that elements are about as long as wide
  Section at(double u) const;

 private:
  struct SectionParameters {
    double s;
    Vec2 factor;
  };
  SectionParameters place(double u) const;
  SectionParameters step(double u) const;
  SectionParameters in_period(double u) const;
  double in_period_along(double s) const;
  void check_period();
  Section section_of(const SectionParameters& place) const;
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
  // half_: half widths of the outline along x2 and x3. height_: length by which the depth of a `step` is multiplied: half_[0] or half_[1] if the
  // cross-section is scaled only along x2 or x3, otherwise the radius of the outline
  double half_[2] = {1, 1}, height_ = 1;
  double first_ = 0, last_ = 0;           // smallest (first_) and largest (last_) arc length s at which the cross-section or the direction of the
                                          // channel changes
  double start_ = 0, end_ = 0, smallest_ = 1;
};

}  // namespace tanktread::surface
