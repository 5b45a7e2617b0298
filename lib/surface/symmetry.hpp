#pragma once
// Reflections that leave a surface and its spline space as they are, and sums over such a surface from one of each set of elements that are images
// of one another.

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::surface {

/// One of the eight maps of the unit square onto itself: coordinates exchanged, then turned around.
struct Turn {
  bool exchanged = false, turned[2] = {false, false};

  std::array<double, 2> operator()(double s, double t) const;
  int bernstein(int b, int p) const;  ///< the image of entry b of a grid of (p + 1) x (p + 1) that is symmetric about its middle
  Turn after(const Turn& first) const;
};

/// x -> c + diag(signs) (x - c) about the middle c of a surface: a mirror plane (one sign is -1), a half turn (two), the point symmetry (three);
/// which control point, and which Bezier element, the image of each one is, and how the parameters of each element are turned.
struct Image {
  Vec3 signs = Vec3::Ones();
  std::vector<int> point, element;
  std::vector<Turn> turn;
};

/// The map of an image about a middle.
struct Reflection {
  Vec3 signs = Vec3::Ones(), middle = Vec3::Zero();

  Vec3 of_vector(const Vec3& v) const { return signs.cwiseProduct(v); }
  Vec3 operator()(const Vec3& x) const { return middle + of_vector(x - middle); }
};

/// The image of the space and of all these nets on it, if it is the same space and nets: places within 1e-10 of the first net's size (what
/// refinement may add to a fit), bases within 1e-10, sites within 1e-9. Elements may turn and change places.
std::optional<Image> image(const spline::Space& space, std::span<const Net* const> nets, const Vec3& signs);

/// A group of such images. Its fundamental control points are one of each set of points that are images of each other, all in one connected part
/// of the surface where that can be.
class Symmetry {
 public:
  /// Of n points that are images of nothing: the identity alone.
  explicit Symmetry(int n_points = 0);

  /// The group that `generators` make; the fundamental points are those of `net` that lie farthest along x1, then x2, then x3.
  Symmetry(const std::vector<Image>& generators, const Net& net);

  int order() const { return order_; }
  const std::vector<Image>& images() const { return images_; }          ///< all but the identity
  const std::vector<int>& fundamental() const { return fundamental_; }  ///< ascending

  const std::vector<int>& source() const { return source_; }  ///< of each point, the fundamental one that it is an image of

  /// What the vector of a point is multiplied by, component by component, to be that of its source's image, shape (N, 3): 1, -1, or 0 where an image
  /// of the point onto itself turns the component around.
  const Net& signs() const { return signs_; }

  /// Makes a field of vectors, control values or values at the sites, symmetric from its rows of the fundamental points. A component that an image
  /// of a point onto itself turns around becomes zero.
  void complete(Net& field) const;

  /// "mirror x2 and point symmetry", or "none".
  const std::string& description() const { return description_; }

 private:
  int order_ = 1;
  std::vector<Image> images_;
  std::vector<int> fundamental_, source_;
  Net signs_;
  std::string description_ = "none";
};

/// The largest group of images of the space and the nets that `keeps` admits (say because they are symmetries of the flow, or of a wall); it is
/// asked before the elements are looked at, and sees where the points go.
Symmetry symmetry(const spline::Space& space, std::span<const Net* const> nets, const std::function<bool(const Image&)>& keeps);

/// One of each set, the one with most fundamental points, ascending; and 1 over the number of images (the identity is one) that leave it in place.
struct FundamentalElements {
  std::vector<int> element;
  std::vector<double> weight;

  bool whole() const;  ///< none is an image of itself
};

/// `points(e)`: the control points of element e.
FundamentalElements fundamental_elements(const Symmetry& symmetry, int n_elements, const std::function<std::span<const int>(int)>& points);

/// From what fundamental elements, each with its weight, add to all rows of a symmetric field, the rows of the fundamental points of the field.
void fold(const Symmetry& symmetry, Net& sums);

/// The fields of one parity: the mirror plane across each axis turns them into themselves (1) or into their opposite (-1), half turns and the point
/// symmetry by the product of their axes. With 1 for all they are the symmetric fields; any field is a sum of one of each parity.
class Parity {
 public:
  explicit Parity(const Symmetry& symmetry, const Vec3& of_planes = Vec3::Ones());

  /// What the vector, or the scalar, of a point is multiplied by to be that of its source's image, as Symmetry::signs.
  const Net& signs() const { return signs_; }
  const Eigen::VectorXd& scalar_signs() const { return scalar_signs_; }

  /// Fields of this parity from their rows of the fundamental points, as Symmetry::complete.
  void complete(Net& field) const;
  void complete(Eigen::VectorXd& field) const;

 private:
  std::vector<int> source_;
  Net signs_;
  Eigen::VectorXd scalar_signs_;
};

}  // namespace tanktread::surface
