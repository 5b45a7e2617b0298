#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/dense_rows.hpp"
#include "stokes/far_kernel.hpp"
#include "stokes/kernels.hpp"
#include "stokes/layer_surface.hpp"
#include "stokes/tree_sum.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// What a density is measured on: per area of the unstressed surface (3.7), or per present area (3.6).
enum class Measure { reference, current };

/// The single layer of a closed spline surface at its own collocation points x_i, without the viscosity:
///
///   u_i = (1 / 8 pi) int G(x, x_i) f dG,   f = sum_B f_B N_B                              (2.1), (2.2)
///
/// by a far sum over Gauss nodes, with rules of their own for panels that a collocation point lies on or is close to, to the accuracy
/// of the options. Each row depends on the shape only, not on the other rows asked for.
///
/// Rule `desingularised`: Gauss nodes alone; what is singular is subtracted by two identities of a closed surface, int G n dG = 0 and
/// that of the flow (n0.r) f_t, after Klaseboer, Sun & Chan, J. Fluid Mech. 696, 2012 (our choice of the flow).
class SingleLayer {
 public:
  SingleLayer(const spline::Space& space, const quadrature::Options& options);

  /// The unstressed surface, which Measure::reference needs. Its areas are kept at all far nodes and self points.
  void set_reference(const Net& unstressed);

  /// States that all shapes and densities to come are of this symmetry, and all targets fundamental. Where far sums are taken by clusters, those are
  /// made of fundamental panels F only, for the others do to a target what these do to its images:
  ///
  ///   u(x_i) = sum over images g of S_g u_F(g x_i),   S_g = diag(signs)                                                      (2.19)
  void set_symmetry(const surface::Symmetry& symmetry);

  /// Shares the far sums of the rows `everybody`, where they are taken by clusters, among callers 0 .. parts - 1: from now on `apply` fills these
  /// rows with what adds up to the layer over all callers; near and singular panels are counted by the caller whose targets they concern.
  void share(int part, int parts, std::vector<int> everybody);
  bool shared() const { return !everybody_.empty(); }

  /// Rows `targets` of u, shape (N, 3), for the density with control values f on the surface x.
  void apply(const Net& x, const Net& f, Measure measure, std::span<const int> targets, Net& u);

  /// Rows `targets` of (1 / 8 pi) int G n dG, which vanishes (2.3): what the rules leave of it.
  void apply_to_normal(const Net& x, std::span<const int> targets, Net& u);

  /// A of u_i = sum_B A_iB f_B: three rows a target, in the order of `targets`; shape (3 targets, 3 N).
  void assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<float>& a);
  void assemble(const Net& x, Measure measure, std::span<const int> targets, Rows<double>& a);

  /// Of A only the blocks A_iB of near control points: entries[6 j + c], c = 11, 12, 13, 22, 23, 33, for near.point[j].
  void assemble(const Net& x, Measure measure, std::span<const int> targets, const NearPoints& near, std::vector<double>& entries);

  /// Kernel evaluations of all calls so far, and where their time went: `setup`, `far`, `near`, `self`, `assembly`.
  const Evaluations& evaluations() const { return evaluations_; }
  const Phases& phases() const { return phases_; }

  /// Far nodes of the whole surface: bare interactions of a dense apply are targets times this.
  int n_nodes() const { return surface_.panels.n_nodes(); }

 private:
  struct Moments;
  void place(const Net& x, Measure measure, std::span<const int> targets, bool lazily = false);
  void load(int e);
  void add_far(std::span<const int> targets, Net& u);
  void add_by_tree(std::span<const int> targets, Net& u);
  template <class Sum>
  void add_near(std::span<const int> targets, const Sum& own_sum, Net& u);
  template <class Sum>
  void add_self(std::span<const int> targets, const Sum& own_sum, Net& u);
  void subtract_identities(std::span<const int> targets, Net& u);
  const Pack* area_weights_of(int e, const PointTable& table, SelfPair* pair);
  Mat3 identities(int target, const Vec3& at) const;
  PointForces forces() const;
  std::span<const int> rows(std::span<const int> targets) const;

  LayerSurface surface_;
  std::optional<TreeSum> tree_;                             // where clusters are faster
  std::vector<int> points_;                                 // targets in the tree
  std::vector<int> everybody_;                              // rows that far sums are shared of; empty: they are not
  Measure measure_ = Measure::current;
  std::vector<double> bezier_unstressed_, bezier_f_;        // Bezier points: unstressed surface, density
  std::vector<double> weight_unstressed_, weight_present_;  // of the far nodes, areas included
  std::vector<double> force_[3], normal_[3];                // far nodes: density times weight, normal times weight
  const Net* density_ = nullptr;                            // of this call
  bool lazily_ = false;                                     // panels are located and loaded where they are asked for
  std::vector<char> loaded_;                                // panels whose far nodes and density are there
  std::vector<Vec3> at_;                                    // the targets of this call
  std::vector<Pack> point_weights_;
  Evaluations evaluations_;
  Phases phases_;
};

}  // namespace tanktread::stokes
