#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/far_kernel.hpp"
#include "stokes/kernels.hpp"
#include "stokes/layer_surface.hpp"
#include "surface/patch.hpp"

namespace tanktread::stokes {

/// Where the surface is nearest to a point close to it.
struct Foot {
  spline::Site site;
  Vec3 x, normal;  ///< outward unit normal
  double distance = 0;
  bool inside = false;  ///< whether the point is in the body
};

/// Layer potentials of a closed spline surface at points off it, however close (present areas, no viscosity):
///
///   single: (1 / 8 pi) int G(x, y) f dG     double: (1 / 8 pi) int v_j(x) T_ijk(x, y) n_k dG                (2.1)
///
/// Close to the surface the double layer is taken of v - v(foot), and what the constant gives is known: -v(foot) inside, 0 outside (2.3).
/// The accuracy of the options is kept at any distance, relative to the largest value of the potential.
class Potentials {
 public:
  Potentials(const spline::Space& space, const quadrature::Options& options);

  /// Takes the shape with control net x.
  void place(const Net& x);

  std::vector<Vec3> single_layer(const Net& f, std::span<const Vec3> points);
  std::vector<Vec3> double_layer(const Net& v, std::span<const Vec3> points);

  /// The pressure layer (1 / 8 pi) int G n dG, which vanishes (2.3), and (1 / 8 pi) int T_ijk n_k dG = -delta_ij inside, 0 outside:
  /// what the rules make of the identities.
  std::vector<Vec3> pressure_layer(std::span<const Vec3> points);
  std::vector<Mat3> solid_angle(std::span<const Vec3> points);

  /// The nearest point of the surface, for points so close that the far rule of some panel is not enough; nothing otherwise.
  std::optional<Foot> foot(const Vec3& y);

  const Evaluations& evaluations() const { return evaluations_; }

 private:
  template <class Far, class Near>
  Vec3 integral(const Vec3& y, const Far& far, const Near& near);
  PointForces forces(const std::vector<double> (&f)[3]) const;
  surface::Patch patch(int panel, const std::vector<double>& bezier) const;
  void take(const Net& field);
  Vec3 double_sum_about(const Vec3& y, const Vec3& v0);

  LayerSurface surface_;
  std::vector<double> bezier_field_;
  std::vector<double> weight_, normal_[3], field_[3];
  std::vector<Pack> point_weights_;
  Evaluations evaluations_;
};

}  // namespace tanktread::stokes
