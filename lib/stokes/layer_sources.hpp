#pragma once
// Surfaces with the density of a layer: quadrature weights and densities at their nodes, and integrals over one of their panels.

#include <optional>
#include <span>
#include <vector>

#include "base/threads.hpp"
#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/kernels/kernels.hpp"
#include "stokes/layer_kernel.hpp"
#include "stokes/layer_surface.hpp"
#include "stokes/sums/far_sums.hpp"
#include "stokes/sums/layer_rule.hpp"

namespace tanktread::stokes {

/// Area to which the density of a single layer refers: unstressed area (3.7), current area (3.6), or a choice between the two for each element
/// (LayerSources::set_reference).
enum class Measure { reference, current, by_element };

/// Values at all far nodes: one array for each of three components.
using NodeVectors = std::vector<double>[3];

/// Surfaces with the density of a single or double layer, in free space: the far nodes with their weights, and the integrals of the free-space kernel
/// over one panel. The order of calls is set_reference() (if a measure needs it), set_shape(), set_density(), then the sums and integrals. A Layer
/// adds the panels up; a LayerMedium adds what the boundaries of the fluid change.
class LayerSources {
 public:
  /// The arguments are explained at the constructor of Layer.
  LayerSources(LayerKernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options,
               std::vector<double> factor);

  LayerKernel kernel() const { return kernel_; }
  int n_nodes() const { return surface.panels.n_nodes(); }
  /// Returns the factor k_p of (2.1) and (2.2) of the surface that contains element e.
  double factor(int e) const { return factor_.empty() ? 1 : factor_[static_cast<std::size_t>(e)]; }
  /// Returns whether the density on element e is a force per unstressed area.
  bool on_reference(int e) const {
    return measure_ == Measure::reference || (measure_ == Measure::by_element && !reference_.per_current_area[static_cast<std::size_t>(e)]);
  }
  /// Returns whether the singularity is subtracted by identities of a closed surface, because there are no singular rules.
  bool desingularised() const { return properties(kernel_).has_identities && !properties(surface.options.rule).has_singular_rules; }

  /// See Layer::set_reference.
  void set_reference(const Net& unstressed, std::vector<bool> per_current_area);
  const std::vector<double>& reference_bezier() const { return reference_.bezier; }  ///< Bezier points of the unstressed surface

  /// Sets the shape x and the area to which densities refer. Returns false if both are the current ones and renew_shape() was not called since.
  bool set_shape(const Net& x, Measure measure);
  void renew_shape() { measure_.reset(); }  ///< makes the next set_shape() compute everything anew

  /// Evaluates a field, given by its control values, at the far nodes.
  void values(const Net& field, NodeVectors& value);
  /// Sets the control values f of the density, and from them `bezier_f` and `density`.
  void set_density(const Net& f);
  /// Returns the integral of a function h times each basis function, the transpose of values(). `g`: h times area and quadrature weight at each far
  /// node.
  Eigen::VectorXd moments(const std::vector<double>& g) const;

  Vec3 mean_density() const;  ///< mean of `density` over the far nodes
  /// Stresslet moments (f n + n f)/2 at the far nodes, with n = `normal`, components as in `stresses`.
  using StressletMoments = std::array<std::vector<double>, 6>;
  /// Returns the stresslet moments of the density minus `mean`, or of a constant unit density along axis `component`. The result is valid until the
  /// next call of one of these functions.
  const StressletMoments& stresslet_moments(const Vec3& mean);
  const StressletMoments& stresslet_moments_of_constant(int component);

  /// Returns the sum of the kernel times the density over the far nodes at the positions x (the far nodes of the surface, or displaced ones), at the
  /// targets `at`; shape (number of targets, 3). `f0`: for each target the constant that is subtracted from the density of a double layer. For all
  /// nodes, or for the nodes of panel e at one target.
  Net direct_sum(const NodeVectors& x, std::span<const Vec3> at, std::span<const Vec3> f0);
  Vec3 direct_sum(int e, const Vec3& at, const Vec3& f0) const;

  /// Returns the integral over panel e by the near-singular or singular rule `table` minus the contribution of the panel to the far sum. `pair`: the
  /// pair of target and panel if the panel contains the target, otherwise null. `count` is increased by the number of kernel evaluations.
  /// Several threads may call this function and the following ones, for different targets.
  Vec3 beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, const Vec3& f0, long long& count);

  /// Computes the integrals of the kernel times each Bernstein polynomial (kernel_entries numbers for each: 11, 12, 13, 22, 23, 33) over panel e by
  /// the rule `table`, times the factor of the panel. moments_beyond_far_sum() subtracts the contribution of the panel to the far sum.
  void panel_moments(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments);
  void moments_beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments);

  /// Returns the weights of a quadrature rule on panel e, times the area element. If the panel contains the target and the areas are unstressed
  /// areas, the weights are kept in `pair`. The result is valid until the next call by the same thread.
  const Pack* area_weights_of(int e, const PointTable& table, SelfPair* pair);

  LayerSurface surface;
  std::vector<double> bezier_f;   ///< Bezier points of the density
  std::vector<double> weight;     ///< quadrature weights of the far nodes, times area and the factor k_p of (2.1), if uses_weights
  NodeVectors density, normal;    ///< values at the far nodes. density: density f (times `weight` if uses_weights). normal: normal times
                                  ///< quadrature weight, area and factor k_p of (2.2)
  Evaluations evaluations;        ///< kernel evaluations since construction, of code that is called from one thread
  PerThread<Evaluations> counts;  ///< kernel evaluations since construction, of loops
  Phases phases;                  ///< computing times since construction

 private:
  /// The unstressed surface.
  struct Reference {
    std::vector<double> bezier, weight;  // Bezier points, and quadrature weights at the far nodes, which include the area
    std::vector<bool> per_current_area;  // for Measure::by_element: for each element, true if the density is per current area
  };
  void set_weights();
  Mat3 kernel_at(int node, const Vec3& r) const;
  void multiply_by_factors(std::span<std::vector<double>> values) const;
  template <class Values>
  const StressletMoments& set_moments(const Values& f);

  LayerKernel kernel_;
  std::vector<double> factor_;
  std::optional<Measure> measure_;  // kind of area (current or unstressed) that `weight` contains; not set before set_shape()
  Reference reference_;
  std::vector<double> bezier_field_;
  StressletMoments moments_;  // result of the latest call of stresslet_moments() or stresslet_moments_of_constant()
  struct Scratch {
    std::vector<Pack> weights, kernel;
  };
  PerThread<Scratch> scratch_;
};

}  // namespace tanktread::stokes
