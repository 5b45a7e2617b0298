#pragma once
// The layers of one surface at points off it: what two surfaces feel of each other.

#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/dense_rows.hpp"
#include "stokes/kernels.hpp"
#include "stokes/layer_surface.hpp"
#include "stokes/single_layer.hpp"

namespace tanktread::stokes {

/// One layer of a spline surface, open or closed, at many points off it, however close, without the viscosity:
///
///   single: u(y) = (1 / 8 pi) int G(x, y) f dG       double: u(y) = (1 / 8 pi) int v_j(x) T_ijk(x, y) n_k dG      (2.1), (2.2)
///
/// by a far sum over Gauss nodes, with a near rule for panels that a point is too close to. The shape is taken once and good for any
/// number of densities.
class CrossLayer {
 public:
  enum class Kernel { single_layer, double_layer };
  CrossLayer(const spline::Space& source, const quadrature::Options& options, Kernel kernel);

  /// The unstressed surface, which Measure::reference needs.
  void set_reference(const Net& unstressed);

  /// Takes the shape, and what a density of the single layer is measured on.
  void place(const Net& x, Measure measure = Measure::current);

  /// What the near rules of some points give beyond the far sum, for any density: 6 Bernstein moments for each point and close panel.
  struct Near {
    std::vector<std::size_t> first;  ///< of target k, in `panels`
    std::vector<int> panels;
    std::vector<double> moments;
  };

  /// For densities that are many, at the same points of the same shape.
  Near near(const Net& at, std::span<const int> targets);

  /// Rows `targets` of u, shape of `at`, at the points with rows `at`. `f`: control values. `kept`: near(at, targets), or nothing.
  void apply(const Net& f, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr);

  /// The same with constants `v0` (a row a point) taken from v. At points outside of a closed surface a constant gives nothing (2.3), so
  /// with v0 the velocity nearby the answer is the same and the integrand is smaller. Double layer.
  void apply(const Net& v, const Net& v0, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr);

  /// The operator: three rows a target, in the order of `targets`; shape (3 targets, 3 N).
  void assemble(const Net& at, std::span<const int> targets, Rows<float>& a);
  void assemble(const Net& at, std::span<const int> targets, Rows<double>& a);

  /// The shape at its far nodes: places, weights with areas (of the measure) and normals times areas.
  int n_nodes() const { return surface_.panels.n_nodes(); }
  const std::vector<double> (&nodes() const)[3] { return surface_.node; }
  const std::vector<double>& weights() const { return weight_; }  ///< of a single layer
  const std::vector<double> (&normals() const)[3] { return normal_; }

  /// A field at the far nodes, and the transpose: int N_A g dG for every A, from what g times area is at the far nodes.
  void values(const Net& field, std::vector<double> (&value)[3]);
  Eigen::VectorXd moments(const std::vector<double>& g) const;

  const Evaluations& evaluations() const { return evaluations_; }
  const Phases& phases() const { return phases_; }  ///< setup, far, near, assembly

 private:
  struct Moments;
  template <class Real>
  void assemble_rows(const Net& at, std::span<const int> targets, Rows<Real>& a);
  template <class Sources, class Own>
  void integrate(const Sources& all, const Net* v0, const Own& own, const Net& at, std::span<const int> targets, Net& u, const Near* kept);
  void add_kept(const Near& kept, const Net* v0, std::span<const int> targets, Net& u) const;
  void near_moments(int e, const PointTable& table, const Vec3& y, double* moments);
  const Pack* area_weights_of(int e, const PointTable& table);

  Kernel kernel_;
  LayerSurface surface_;
  Measure measure_ = Measure::current;
  std::vector<double> bezier_unstressed_, bezier_f_;
  std::vector<double> weight_, weight_unstressed_, normal_[3], strength_[3];
  std::vector<Pack> point_weights_, scratch_;
  Evaluations evaluations_;
  Phases phases_;
};

}  // namespace tanktread::stokes
