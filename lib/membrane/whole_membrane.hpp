#pragma once
// Global elasticity of a membrane: resistance to changes of its total area, and of the area difference between its two leaflets.

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "membrane/load.hpp"
#include "membrane/membrane.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// Stiffnesses of the global elasticity; a stiffness of 0 means that the term is absent.
struct WholeStiffness {
  double area = 0;                        ///< K, modulus that resists changes of the total area (3.26), force/length
  double leaves = 0;                      ///< kbar, modulus of the area difference of the leaflets (3.27), force x length
  /// reference area difference Q0 divided by the area difference of a sphere of equal area; if not given, Q0 is taken from the unstressed shape X
  std::optional<double> leaf_difference;

  bool any() const { return area > 0 || leaves > 0; }
};

/// Load and tangent of two energies E of the whole membrane, each a function of one surface integral Q:
///
///   E = k/2 (Q - Q0)^2,   dE/dx = k (Q - Q0) q,   q = dQ/dx,   Q = x.q/m
///
/// - Total area (3.26): Q = A, k = K/A0, m = 2.
/// - Area difference of the leaflets divided by their distance (3.27): Q = N = int 2 chi dGamma, k = pi kbar/A0, m = 1.
///
/// K and kbar are the moduli in WholeStiffness, chi is the mean curvature, and A0 is the area of the unstressed surface. Q is homogeneous of degree m
/// in x, so Q follows from its gradient q. Only q is summed over ranks.
class WholeMembrane : public Load {
 public:
  /// `space` must outlive this object. `radius`: particle radius R_C.
  WholeMembrane(const spline::Space& space, const Net& unstressed, double radius, const WholeStiffness& stiffness);

  std::size_t n_sums() const override { return measures_.size(); }
  void add_work(const Net& x, std::span<const int> elements, Net& work, std::span<Net> sums) const override;
  void add_global_work(const Net& x, std::span<const Net> sums, Net& work) const override;
  bool stores() const override { return true; }
  double energy(const Net& x, std::span<const Net> sums) const override;
  void linearise(const Net& x, std::span<const int> elements, std::span<const Net> sums) override;
  void add_tangent(const Net& dx, Net& change) const override;         ///< adds k (Q - Q0) (dq/dx) dx (symbols: see above), due to the change of q
  void add_global_tangent(const Net& dx, Net& change) const override;  ///< adds k q (q.dx) (symbols: see above), due to the change of Q
  bool admits(const surface::Image&) const override { return true; }
  RigidConditions rigid_conditions() const override { return RigidConditions(0, 6); }
  bool depends_on_labels() const override { return false; }

 private:
  struct Measure {
    int degree;                                      // m: Q(x) is homogeneous of degree m = 2 (total area) or m = 1 (area difference)
    std::vector<std::pair<double, Membrane>> parts;  // pairs of a factor and a membrane: Q is the sum of factor times energy of the membrane
    double stiffness = 0, relaxed = 0;               // k, Q0
    std::vector<Tangent> tangents = {};              // tangent of each membrane in `parts`
    double tension = 0;                              // derivative k (Q - Q0) of the energy (3.26) or (3.27) with respect to Q, at the shape of
                                                     // linearise()
    Net q = {};                                      // q at the linearisation

    double operator()(const Net& x, const Net& gradient) const { return x.cwiseProduct(gradient).sum() / degree; }
    Net gradient_at(const Net& x, std::span<const int> elements) const;
  };
  std::vector<Measure> measures_;
};

}  // namespace tanktread::membrane
