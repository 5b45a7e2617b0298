#pragma once
// The elastic membrane (or fluid interface) in the weak form: stored energy, load by virtual work, and tangent of the load.

#include <memory>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "membrane/laws.hpp"
#include "spline/space.hpp"
#include "surface/patch.hpp"

namespace tanktread::membrane {

struct Part;

/// Summary of tensions and area changes over the Gauss points, for the columns `smallest_tension`, `compressed_area` and `local_area_change` of the
/// time series. smallest: smallest principal tension divided by the modulus. compressed_area: fraction of the current area in which a principal
/// tension is less than -1e-9 of the modulus. area_change: largest |J - 1|, with J the ratio of current to unstressed area. rms_area_change: root
/// mean square of J - 1 over the unstressed area.
struct TensionSummary {
  double smallest = 0, compressed_area = 0, area_change = 0, rms_area_change = 0;
};

/// Contributions of some elements to a TensionSummary: the smallest tension and the largest |J - 1| on the given elements, and for each element of
/// the space its area, its area under compression, its unstressed area and the integral of (J - 1)^2 over its unstressed area. All are zero for
/// elements that are not given.
struct ElementTensions {
  double smallest = 0, area_change = 0;
  std::vector<double> area, compressed, unstressed, squared_change;
};

/// A membrane: a spline space, its unstressed net X, a law and a Gauss rule. Uses no MPI. The argument `elements` lists the elements to evaluate, in
/// ascending order. Each row of a load is summed in the same order, however the elements are distributed over the ranks of the calling program.
///
/// Its functions use all threads, and are called by one: the packed elements of the latest calls are cached.
class Membrane {
 public:
  /// `order`: number of Gauss points per direction on elements up to degree 3, from 2 to 10, and one more for each degree above 3. `space` must
  /// outlive the membrane.
  Membrane(const spline::Space& space, const Net& unstressed, const Law& law, int order = 4, const Bending& bending = {})
      : Membrane(space, unstressed, Materials{{{law, bending}}, {}}, order) {}

  /// Creates a membrane of several materials.
  Membrane(const spline::Space& space, const Net& unstressed, const Materials& materials, int order = 4);

  /// Returns the energy E = int Psi dGamma_0 plus the bending energy of each element of the space, zero for elements that are not given, with the
  /// strain energy Psi per unstressed area. Units force x length.
  std::vector<double> element_energies(const Net& x, std::span<const int> elements) const;

  /// Computes the load d_A = int tau^ab R_A,a g_b dGamma = dE/dx_A, with R_A the spline functions, shape (N, 3); d is set to zero first (3.6). A row
  /// is complete if the whole support of its function is in `elements`. Units force.
  void load(const Net& x, std::span<const int> elements, Net& d) const;
  Net load(const Net& x) const;

  /// Returns the tensions and area changes. `uniform`: uniform tension that a load adds, divided by the modulus.
  ElementTensions element_tensions(const Net& x, std::span<const int> elements, double uniform = 0) const;

  /// Returns the strong form of the load, t = -div_s tau (equation 3 of Maestre et al. 2017), at a parametric point. It uses second derivatives of
  /// the current and the unstressed net, and leaves out bending. The result is a force per current area.
  Vec3 strong_load(const Net& x, const spline::Site& site) const;

  /// Evaluates the strong form of the load at the collocation points `targets`, as the average over the elements that meet there. Sets only the rows
  /// `targets` of t. The strong form fails in the cases documented in `tests/stability`.
  void strong_load(const Net& x, std::span<const int> targets, Net& t) const;

  const spline::Space& space() const { return *space_; }
  const Net& unstressed() const { return unstressed_; }
  const Materials& materials() const { return materials_; }
  const Law& law(int element = 0) const { return materials_.all[materials_.of_element.empty() ? 0 : materials_.of_element[element]].law; }
  int order() const { return order_; }

 private:
  friend class Tangent;
  friend class ViscousLoad;
  std::shared_ptr<const Part> part(std::span<const int> elements) const;

  const spline::Space* space_;
  Net unstressed_;
  Materials materials_;
  int order_;
  std::vector<int> all_;
  mutable std::vector<std::shared_ptr<const Part>> parts_;  // latest last
};

/// Returns the principal tensions, smaller first, divided by the modulus, from jets of the unstressed and current surface. Shape (points, 2).
Eigen::MatrixX2d tensions(const Law& law, std::span<const surface::Jet> unstressed, std::span<const surface::Jet> now);

/// Symmetric operator H that gives a load that is linear in a displacement or a velocity u. It is applied without being assembled.
class LinearLoad {
 public:
  explicit LinearLoad(const Membrane& membrane);
  ~LinearLoad();
  LinearLoad(LinearLoad&&) noexcept;

  /// Sets `hu` to H u, shape (N, 3). Only the elements of the last update() of the derived class contribute. A row is complete if the whole support
  /// of its function is in these elements.
  void apply(const Net& u, Net& hu) const;

 protected:
  struct Points;
  const Membrane* membrane_;
  std::unique_ptr<Points> points_;
};

/// Hessian H = d^2E/dx^2 of the energy at a configuration.
class Tangent : public LinearLoad {
 public:
  using LinearLoad::LinearLoad;
  void update(const Net& x, std::span<const int> elements);  ///< linearises the load at x on the given elements
};

/// Viscous load (3.10) of the membrane in a given shape: (C v)_A = int J tau^ab R_A,a g_b for the velocity v, with R_A the spline functions. C is
/// symmetric, and v.C v is the dissipated power.
class ViscousLoad : public LinearLoad {
 public:
  using LinearLoad::LinearLoad;
  void update(const Net& x, std::span<const int> elements);  ///< sets the shape x and the elements that apply() uses
};

/// Returns the unstressed net of a membrane that is inflated to `rest`: X = centre + (x - centre)/(1 + alpha).
Net unstressed(const Net& rest, const Vec3& centre, double alpha);

}  // namespace tanktread::membrane
