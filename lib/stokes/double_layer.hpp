#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/dense_rows.hpp"
#include "stokes/far_kernel.hpp"
#include "stokes/kernels.hpp"
#include "stokes/layer_surface.hpp"
#include "stokes/tree_sum.hpp"

namespace tanktread::stokes {

/// The double layer of closed spline surfaces p at their own collocation points x_i, regularised, so that no principal value is taken:
///
///   (H v)_i = sum_p (k_p / 8 pi) int_p (v_j(x) - v_j(x_i)) T_ijk n_k dG,   v = sum_B v_B N_B         (2.1), (2.2)
///
/// n out of the surface. Of the surface that x_i lies on this is k times the principal value plus v/2; another gives what it gives without v_j(x_i),
/// for the integral of T n over it is 0 (2.3). As x_i comes near it the integrand grows like 1 / r^2, for v there may be any other than v(x_i), and
/// near rules of other surfaces are made for that. Rigid-body motions of all give 0. Rules on the own surface as for the single layer; under
/// `desingularised` the difference in the integrand is all that is done about the singularity.
class DoubleLayer {
 public:
  /// `factor`: k of each element; 1 where there are none.
  DoubleLayer(const spline::Space& space, const quadrature::Options& options, std::vector<double> factor = {});

  /// Shares the far sums of the rows `everybody` among callers, as SingleLayer::share does.
  void share(int part, int parts, std::vector<int> everybody);
  bool shared() const { return !everybody_.empty(); }

  /// Rows `targets` of H v, shape (N, 3), for the velocity with control values v on the surface x.
  void apply(const Net& x, const Net& v, std::span<const int> targets, Net& hv);

  /// The operator itself: three rows a target, in the order of `targets`; shape (3 targets, 3 N).
  void assemble(const Net& x, std::span<const int> targets, Rows<float>& a);
  void assemble(const Net& x, std::span<const int> targets, Rows<double>& a);

  /// Whether the far sum is taken by clusters, so that applying is faster than assembling for a few products.
  bool by_clusters() const { return tree_.has_value(); }

  /// Kernel evaluations of all calls so far.
  const Evaluations& evaluations() const { return evaluations_; }

 private:
  struct Moments;
  void place(const Net& x, std::span<const int> targets);
  double factor(int e) const { return factor_.empty() ? 1 : factor_[static_cast<std::size_t>(e)]; }
  void add_far(std::span<const int> targets, Net& hv);
  void add_by_tree(std::span<const int> targets, Net& hv);
  void place_tree(std::span<const int> targets);
  void add_near(std::span<const int> targets, Net& hv);
  Stresslets nodes() const;
  std::vector<Vec3> values(std::span<const int> targets) const;

  LayerSurface surface_;
  std::vector<double> factor_;                              // k of each panel
  std::vector<double> bezier_v_, velocity_[3], normal_[3];  // of the far nodes; normals times weights and k
  std::vector<Vec3> at_;
  std::optional<TreeSum> tree_;  // where clusters are faster
  std::vector<int> everybody_;   // rows that far sums are shared of; empty: they are not
  Net x_, tree_x_;               // shape; that of the tree and of stress_
  std::vector<int> tree_targets_;
  std::vector<double> stress_;     // 8 pi times the solid angle of the far nodes at tree_targets_, six numbers each
  std::vector<double> moment_[6];  // of the far nodes: symmetric part of velocity times normal
  Evaluations evaluations_;
};

}  // namespace tanktread::stokes
