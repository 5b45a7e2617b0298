#pragma once

#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/assembly_kernel.hpp"
#include "stokes/far_kernel.hpp"
#include "stokes/kernels.hpp"
#include "stokes/near_field.hpp"
#include "stokes/panels.hpp"
#include "stokes/self_field.hpp"

namespace tanktread::stokes {

/// What a density is measured on: per area of the unstressed surface (3.7), or per present area (3.6).
enum class Measure { reference, current };

/// Rows of a dense operator, as the Jacobian keeps them (float) or as a test needs them (double).
template <class Real>
using Rows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using DenseRows = Rows<float>;

/// The single layer of a closed spline surface at its own collocation points x_i, without the viscosity:
///
///   u_i = (1 / 8 pi) int G(x, x_i) f dG,   f = sum_B f_B N_B                              (2.1), (2.2)
///
/// by a far sum over Gauss nodes, with rules of their own for panels that a collocation point lies on or is close to
/// (splines.md, F), to the accuracy of the options. Each row depends on the shape only, not on the other rows asked for.
class SingleLayer {
 public:
  SingleLayer(const spline::Space& space, const quadrature::Options& options);

  /// The unstressed surface, which Measure::reference needs. Its areas are kept at all far nodes and self points.
  void set_reference(const Net& unstressed);

  /// Rows `targets` of u, shape (N, 3), for the density with control values f on the surface x.
  void apply(const Net& x, const Net& f, Measure measure, std::span<const int> targets, Net& u);

  /// A of u_i = sum_B A_iB f_B: three rows a target, in the order of `targets`; shape (3 targets, 3 N).
  void assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<float>& a);
  void assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<double>& a);

  /// Kernel evaluations of all calls so far, and where their time went: `setup`, `far`, `near`, `self`, `assembly`.
  const Evaluations& evaluations() const { return evaluations_; }
  const Phases& phases() const { return phases_; }

  /// Far nodes of the whole surface: bare interactions of an apply are targets times this.
  int n_nodes() const { return panels_.n_nodes(); }

 private:
  void place(const Net& x, Measure measure, std::span<const int> targets);
  void add_far(std::span<const int> targets, Net& u);
  void add_near(std::span<const int> targets, Net& u);
  void add_self(std::span<const int> targets, Measure measure, Net& u);
  void list_near(int target, const Vec3& at);
  const Pack* self_weights(SelfPair& pair, Measure measure);
  PointForces forces() const;

  template <class Real>
  void assemble_rows(const Net& x, Measure measure, std::span<const int> targets, Rows<Real>& a);
  template <class Real>
  void add_own_rules(int target, const Vec3& at, Measure measure, Real* sums);

  quadrature::Options options_;
  int n_points_;
  Panels panels_;
  NearField near_field_;
  SelfField self_field_;
  std::vector<double> bezier_unstressed_, bezier_, bezier_f_;     // Bezier points: unstressed and present surface, density
  std::vector<double> weight_unstressed_, weight_present_;        // of the far nodes, areas included
  std::vector<double> node_[3], force_[3];                        // far nodes: position, density times weight
  const std::vector<double>*weight_ = nullptr, *area_ = nullptr;  // the weights in use and the Bezier points of their surface
  std::vector<Vec3> at_;                                          // the targets of this call
  std::vector<int> near_;
  std::vector<Pack> point_weights_, scratch_;
  std::vector<double> moments_;
  Evaluations evaluations_;
  Phases phases_;
};

}  // namespace tanktread::stokes
