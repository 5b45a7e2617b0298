#pragma once
// What a membrane resists as a whole: a change of its area, and of the difference between the areas of its two leaves.

#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "coupling/particle.hpp"
#include "membrane/membrane.hpp"
#include "spline/space.hpp"

namespace tanktread::coupling {

/// The energies of two measures Q of each particle's whole membrane, their load and their tangent; nothing of particles whose stiffness is 0:
///
///   E = k/2 (Q - Q0)^2,   dE/dx = k (Q - Q0) q,   q = dQ/dx,   Q = x.q/m
///
/// Area A: k = K/A0, m = 2 (3.26). Difference between the areas of leaves a unit apart, N = int 2 chi dGamma: k = pi kbar/A0, m = 1 (3.27). A0 is
/// that of the unstressed surface. Q is homogeneous in x, of degree m, so that its gradient tells it. The caller sums what `gradients` gives over
/// ranks and images before any other function takes it.
class WholeMembrane {
 public:
  /// `space` must outlive this.
  WholeMembrane(const spline::Space& space, const Net& unstressed, std::span<const Particle> particles);

  /// Whether some particle has a stiffness.
  static bool needed(std::span<const Particle> particles);

  /// What `elements` give to the gradient q of each measure, as Membrane::load.
  std::vector<Net> gradients(const Net& x, std::span<const int> elements) const;

  /// Of particle p, both measures together; `q` are the complete gradients at x, here and below.
  double energy(const Net& x, const std::vector<Net>& q, std::size_t p) const;

  /// Adds dE/dx_A to d.
  void add_load(const Net& x, const std::vector<Net>& q, Net& d) const;

  /// Linearises at x, on these elements.
  void update(const Net& x, std::vector<Net> q, std::span<const int> elements);

  /// Adds what the elements of `update` give to k (Q - Q0) dq/dx u, as Tangent::apply.
  void add_turning(const Net& u, Net& hu) const;

  /// Adds the complete k q (q.u).
  void add_stretching(const Net& u, Net& hu) const;

 private:
  struct Of {  // a particle
    spline::Block block;
    double stiffness, relaxed;  // k, Q0
    double tension = 0;         // k (Q - Q0) where linearised
  };
  struct Measure {
    int degree;                                                // m
    std::vector<std::pair<double, membrane::Membrane>> parts;  // factors and membranes: Q is the sum of each factor times the energy
    std::vector<Of> particles;                                 // that resist
    std::vector<membrane::Tangent> tangents = {};              // of the parts
    Net q = {};                                                // where linearised

    double operator()(const Net& x, const Net& gradient, const spline::Block& block) const {
      return block.rows(x).cwiseProduct(block.rows(gradient)).sum() / degree;
    }
    std::vector<int> mine(std::span<const int> elements) const;
    Net gradient_at(const Net& x, std::span<const int> elements) const;
  };
  std::vector<Measure> measures_;
};

}  // namespace tanktread::coupling
