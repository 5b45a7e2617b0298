#pragma once
// The elastic membrane (or fluid interface) in the weak form: stored energy, load by virtual work, tangent of the load.

#include <memory>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "membrane/laws.hpp"
#include "spline/space.hpp"
#include "surface/patch.hpp"

namespace tanktread::membrane {

struct Part;

/// Smallest principal tension over the modulus, the share of the current area where it is negative, and the largest |J - 1|, J the current over the
/// unstressed area of a place (`smallest_tension`, `compressed_area`, `local_area_change` of the series); at the Gauss points. A tension counts as
/// negative below -1e-9 of the modulus.
struct TensionSummary {
  double smallest = 0, compressed_area = 0, area_change = 0;
};

/// What it is made of: the smallest tension and the largest |J - 1| on some elements, and of each element of the space the area and that with a
/// negative tension, zero for elements that were not asked for.
struct ElementTensions {
  double smallest = 0, area_change = 0;
  std::vector<double> area, compressed;
};

/// A membrane: a spline space, its unstressed net X, a law and a Gauss rule. Serial; `elements` are those that the caller is to do,
/// ascending. What a row of a load receives is summed in an order that does not depend on how elements are split over callers.
///
/// Not for concurrent calls: the elements of the latest calls are kept packed for the hot loops.
class Membrane {
 public:
  /// `order` Gauss points per direction at degree 3, one more for each degree beyond; 2 to 10. `space` must outlive the membrane.
  Membrane(const spline::Space& space, const Net& unstressed, const Law& law, int order = 4, const Bending& bending = {})
      : Membrane(space, unstressed, Materials{{{law, bending}}, {}}, order) {}

  /// A membrane whose elements are of several materials.
  Membrane(const spline::Space& space, const Net& unstressed, const Materials& materials, int order = 4);

  /// E = int Psi dGamma_0, and the bending energy, over all or the given elements. Units force x length.
  double energy(const Net& x) const;
  double energy(const Net& x, std::span<const int> elements) const;

  /// The energy of each element of the space, zero for those that are not asked for.
  std::vector<double> element_energies(const Net& x, std::span<const int> elements) const;

  /// d_A = int tau^ab R_A,a g_b dGamma = dE/dx_A, shape (N, 3), zeroed first. (3.6)  P-31, P-32
  /// Complete in the rows whose whole support is in `elements`. Units force.
  void load(const Net& x, std::span<const int> elements, Net& d) const;
  Net load(const Net& x) const;

  /// Smallest principal tension over all Gauss points, and where it is compressive.
  TensionSummary tension_summary(const Net& x) const;
  ElementTensions element_tensions(const Net& x, std::span<const int> elements) const;

  /// The strong form t = -div_s tau at a site, bending left out, with second derivatives of both nets. Force per current area. P-3
  Vec3 strong_load(const Net& x, const spline::Site& site) const;

  /// The same at the collocation sites `targets` (rows of t; others are untouched), mean over the incident elements. The paper and
  /// `tests/stability` show where this fails.
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
  mutable std::vector<std::shared_ptr<const Part>> parts_;  // the latest first
};

/// Principal tensions, smaller first, over the modulus, where the unstressed and the present surface are so. Shape (places, 2).
Eigen::MatrixX2d tensions(const Law& law, std::span<const surface::Jet> unstressed, std::span<const surface::Jet> now);

/// H = d^2E/dx^2 at a configuration, symmetric, applied without being assembled.
class Tangent {
 public:
  explicit Tangent(const Membrane& membrane);
  ~Tangent();
  Tangent(Tangent&&) noexcept;

  /// Linearises at x on the given elements.
  void update(const Net& x, std::span<const int> elements);

  /// Hu = H u, shape (N, 3), zeroed first, from the elements of the last update; rows complete as in Membrane::load.
  void apply(const Net& u, Net& hu) const;

 private:
  struct Points;
  const Membrane* membrane_;
  std::unique_ptr<Points> points_;
};

/// What the membrane's viscosity (3.10) does at a configuration: (C v)_A = int J tau^ab R_A,a g_b of the velocity v, C symmetric, v.C v dissipated.
class ViscousLoad {
 public:
  explicit ViscousLoad(const Membrane& membrane);
  ~ViscousLoad();
  ViscousLoad(ViscousLoad&&) noexcept;

  /// Takes the shape, on the given elements.
  void update(const Net& x, std::span<const int> elements);

  /// Cv = C v, shape (N, 3), zeroed first, from the elements of the last update; rows complete as in Membrane::load.
  void apply(const Net& v, Net& cv) const;

 private:
  struct Points;
  const Membrane* membrane_;
  std::unique_ptr<Points> points_;
};

/// The unstressed net of a membrane that is inflated to `rest`: X = centre + (x - centre)/(1 + alpha).
Net unstressed(const Net& rest, const Vec3& centre, double alpha);

}  // namespace tanktread::membrane
