#pragma once
// What a membrane resists as a whole: a change of its area, and of the difference between the areas of its two leaves.

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "membrane/load.hpp"
#include "membrane/membrane.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// Stiffnesses of a whole membrane; 0: none.
struct WholeStiffness {
  double area = 0;                        ///< K of the whole area (3.26), force/length
  double leaves = 0;                      ///< kbar of the difference between its leaves' areas (3.27), force x length
  std::optional<double> leaf_difference;  ///< without stress, over that of a sphere of its area; if not given, the unstressed surface's

  bool any() const { return area > 0 || leaves > 0; }
};

/// The energies of two measures Q of the whole membrane, their load and their tangent:
///
///   E = k/2 (Q - Q0)^2,   dE/dx = k (Q - Q0) q,   q = dQ/dx,   Q = x.q/m
///
/// Area A: k = K/A0, m = 2 (3.26). Difference between the areas of leaves a unit apart, N = int 2 chi dGamma: k = pi kbar/A0, m = 1 (3.27). A0 is
/// that of the unstressed surface. Q is homogeneous in x, of degree m, so that its gradient q, which is the sum that each needs, gives Q.
class WholeMembrane : public Load {
 public:
  /// `space` must outlive this. `radius`: R_C.
  WholeMembrane(const spline::Space& space, const Net& unstressed, double radius, const WholeStiffness& stiffness);

  std::size_t n_sums() const override { return measures_.size(); }
  void add_work(const Net& x, std::span<const int> elements, Net& work, std::span<Net> sums) const override;
  void add_global_work(const Net& x, std::span<const Net> sums, Net& work) const override;
  bool stores() const override { return true; }
  double energy(const Net& x, std::span<const Net> sums) const override;
  void linearise(const Net& x, std::span<const int> elements, std::span<const Net> sums) override;
  void add_tangent(const Net& dx, Net& change) const override;         ///< k (Q - Q0) dq/dx dx
  void add_global_tangent(const Net& dx, Net& change) const override;  ///< k q (q.dx)
  bool admits(const surface::Image&) const override { return true; }
  RigidConditions rigid_conditions() const override { return RigidConditions(0, 6); }
  bool depends_on_labels() const override { return false; }

 private:
  struct Measure {
    int degree;                                      // m
    std::vector<std::pair<double, Membrane>> parts;  // factors and membranes: Q is the sum of each factor times the energy
    double stiffness = 0, relaxed = 0;               // k, Q0
    std::vector<Tangent> tangents = {};              // of the parts
    double tension = 0;                              // k (Q - Q0) where linearised
    Net q = {};                                      // where linearised

    double operator()(const Net& x, const Net& gradient) const { return x.cwiseProduct(gradient).sum() / degree; }
    Net gradient_at(const Net& x, std::span<const int> elements) const;
  };
  std::vector<Measure> measures_;
};

}  // namespace tanktread::membrane
