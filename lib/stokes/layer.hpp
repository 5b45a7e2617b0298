#pragma once
// Layer potentials of spline surfaces, at targets on and off the surfaces.

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/cluster_sums.hpp"
#include "stokes/layer_sources.hpp"
#include "stokes/medium/lattice.hpp"
#include "stokes/medium/medium.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// Single or double layer potential of spline surfaces p, open or closed, at targets x0 on or off them. f_B are the control values of the density,
/// dGamma is the area element, and k_p is a factor per surface, by default 1. The viscosity is not included.
///
///   single:  u(x0) = sum_p (k_p / 8 pi) int_p G(x, x0) f dGamma                             f = sum_B f_B N_B               (2.1)
///   double:  u(x0) = sum_p (k_p / 8 pi) int_p (f_j(x) - f_j(x0)) T_ijk(x, x0) n_k dGamma    n out of the surface            (2.2)
///
/// In the double layer, f(x0) is the density at a target on a surface, so that no principal value is needed. The contribution of the surface that
/// contains the target equals k_p times the sum of the principal value and f/2. If f is a rigid motion of all surfaces, u is 0. For a target off the
/// surfaces, f(x0) is a constant given by the caller, by default 0. This constant does not change u if the target is outside a closed surface (2.3).
///
/// The far-field sum over the Gauss nodes of all panels is evaluated to the tolerance, directly or by clusters (ClusterSums). On panels that are
/// close to a target or contain it, near-singular or singular quadrature (NearField, SelfField) replaces the panel's terms. The tolerance of this
/// quadrature is relative to an integral over the panel's whole surface. The value at a target does not depend on which other targets are requested.
/// The quadrature rule `desingularised` uses only the Gauss nodes. This rule subtracts the singularity of the single layer by two identities of a
/// closed surface: the integral of G n is 0, and the boundary integral identity of the linear flow (n0.r) f_t, where n0 is the normal and f_t the
/// tangential density at the target. After Klaseboer, Sun & Chan, J. Fluid Mech. 696, 2012, who use a different flow.
///
/// Order of calls: set_reference(), set_symmetry(), set_medium() or repeat(), and share(), each only if it is needed; then set_shape() for each
/// shape; then apply(), near() or assemble() for any number of densities. repeat() may be called again at any time, also after share(). After each
/// call of these functions other than apply(), near() and assemble(), set_shape() must be called before the next result.
class Layer {
 public:
  using Kernel = LayerKernel;

  /// `sites`: targets on the surfaces, for example the space's `collocation`; if empty, all targets are off the surfaces. `factor`: factor k_p of
  /// (2.1) and (2.2) for each element; if empty, it is 1.
  Layer(Kernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options, std::vector<double> factor = {});

  /// Sets the unstressed surface, to whose area the densities refer with Measure::reference. The unstressed areas are stored for all far nodes and
  /// all points of singular rules. `per_current_area`: for each element, whether Measure::by_element selects the current area (true) or the
  /// unstressed area (false).
  void set_reference(const Net& unstressed, std::vector<bool> per_current_area = {});

  /// Sets the symmetry that all later shapes and densities have. All later targets must be fundamental sites (one site of each orbit). If the far sum
  /// of a single layer uses clusters, it is computed as the sum u_F over the fundamental panels only. The sum over all panels then follows from u_F
  /// at the images g x_i of each target x_i:
  ///
  ///   u(x_i) = sum over images g of S_g u_F(g x_i),   S_g = diag(+-1)                                                         (2.19)
  void set_symmetry(const surface::Symmetry& symmetry);

  /// Sets the medium, by default unbounded fluid. All later shapes must be in it. Throws std::logic_error if the layer has a medium or a lattice
  /// already, if share() has divided its far sums, or if the quadrature rule does not correct panels close to a target (corrects_near). Blocks that
  /// are assembled for near control points do not include what the medium adds.
  void set_medium(const Medium& medium);

  /// Sets the lattice `cell` on which the surfaces repeat, so that G and T become the kernels of PeriodicKernel. Must be called again, and before
  /// set_shape(), when the cell deforms. With three periods, a double layer includes an additional pressure linear in x. The double layer then does
  /// not change the mean velocity over the cell, including the volume inside the surfaces:
  ///
  ///   T_ijk = T^P_ijk - (8 pi/V) delta_jk (x - x_p)_i,   x_p a point of surface p.                                              (2.28)
  ///
  /// The integral of T n over a closed surface then has the same values as without a lattice (2.3). Assembled rows do not include images unless `how`
  /// requests them.
  void repeat(const PeriodicCell& cell, const Repetition& how = {});

  /// If far sums use clusters, divides the far sums at the sites `everybody` among the ranks 0 .. parts - 1; `part` is the number of this rank. Then
  /// `apply` computes only the share of this rank in the rows `everybody`. The caller must sum these rows over all ranks. Near-singular and singular
  /// quadrature is included only by the rank that requests the row. `everybody`: ascending; contains the sites of all later calls of `apply`, which
  /// must be ascending, too.
  void share(int part, int parts, std::vector<int> everybody);
  bool shared() const { return clusters_ && parts_ > 1; }

  /// Returns whether far sums use clusters. If so, a few products are computed faster by `apply` than with assembled rows.
  bool by_clusters() const { return clusters_.has_value(); }

  /// Sets the shape x, which is kept for any number of densities. `measure`: area to which the density of a single layer refers.
  void set_shape(const Net& x, Measure measure = Measure::current);

  /// Computes rows `sites` of u for the density with control values f. `u`: shape (number of all sites, 3).
  void apply(const Net& f, std::span<const int> sites, Net& u);

  /// Corrections of the far sum by near-singular quadrature at points off the surfaces, for any density. For each pair of a point and a close panel,
  /// the corrections are stored as moments: kernel_entries per Bernstein polynomial of the panel.
  struct Near {
    std::vector<std::size_t> first, first_moment;  ///< for each target, index in `panels` at which the list of the target's close panels begins, and
                                                   ///< index of its first moment
    std::vector<int> panels;
    std::vector<double> moments;
  };

  static constexpr int no_row = std::numeric_limits<int>::max();  ///< value of `first_image_row` if the surfaces contribute to all targets

  /// Returns the corrections at points `at` for the current shape, to be reused for many densities with equal `at`, `targets` and `first_image_row`.
  Near near(const Net& at, std::span<const int> targets, int first_image_row = no_row);

  /// Computes the layer potential at points off the surfaces: row i of u at the point `at.row(i)`, for each i in `targets`. u has the shape of `at`.
  /// `kept`: result of near(at, targets, first_image_row), or null. To rows `first_image_row` and higher, only the images of the surfaces on the
  /// lattice contribute, not the surfaces themselves.
  void apply(const Net& f, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr, int first_image_row = no_row);

  /// Computes the double layer after a constant, row k of `f0`, is subtracted from f for target k. Outside a closed surface the result does not
  /// change (2.3), but the integrand is smaller if f0 is the density nearby.
  void apply(const Net& f, const Net& f0, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr,
             int first_image_row = no_row);

  /// Assembles the matrix A of the layer potential u_i = sum_B A_iB f_B: three rows per target, in the order of `sites` or `targets`; shape (3 x
  /// number of targets, 3 x number of control points). With Repetition::assembled, the rows of a single layer at `sites` include all images
  /// on the lattice and must be in double precision; other rows include only the near images.
  template <class Real>
  void assemble(std::span<const int> sites, Rows<Real>& a);
  template <class Real>
  void assemble(const Net& at, std::span<const int> targets, Rows<Real>& a);

  /// Assembles rows as assemble(at, targets, a) does, but only of the near images of the surfaces on the lattice, without the surfaces themselves.
  void assemble_images(const Net& at, std::span<const int> targets, Rows<float>& a);

  /// Assembles only the blocks A_iB of near control points of a single layer: entries[6 j + c], c = 11, 12, 13, 22, 23, 33, for near.point[j].
  /// Consecutive targets should be neighbours, because targets are processed in groups of sixteen, and each group evaluates the panels around the
  /// near points of all its targets.
  void assemble(std::span<const int> sites, const NearPoints& near, std::vector<double>& entries);

  /// Return the far nodes of the current shape: their number, positions, weights (single layer) and normals (double layer). Weights and normals
  /// include the area of the node and the factor k_p of (2.1), (2.2).
  int n_nodes() const { return sources_.n_nodes(); }
  const NodeVectors& nodes() const { return sources_.surface.node; }
  const std::vector<double>& weights() const { return sources_.weight; }
  const NodeVectors& normals() const { return sources_.normal; }

  /// Evaluates a field, given by its control values, at the far nodes.
  void values(const Net& field, NodeVectors& value) { sources_.values(field, value); }
  /// Returns the integral of a function h times each basis function, the transpose of values(). `g`: h times area and quadrature weight at each far
  /// node.
  Eigen::VectorXd moments(const std::vector<double>& g) const { return sources_.moments(g); }

  /// Returns the number of kernel evaluations since construction.
  Evaluations evaluations() const { return sources_.evaluations + sources_.counts.sum(); }
  /// Returns the computing times since construction, divided into `setup`, `far`, `near`, `self` and `assembly`, and further phases for a lattice or
  /// a wall.
  const Phases& phases() const { return sources_.phases; }

 private:
  /// Returns the tolerance of the sum by clusters.
  double cluster_tolerance() const { return properties(sources_.kernel()).cluster_tolerance_factor * sources_.surface.options.tolerance; }
  void use_clusters();
  void require_no_medium() const;
  void use(std::unique_ptr<LayerMedium> medium);
  void integrate(const LayerTargets& targets, const Near* kept, Net& u);
  void set_far(const LayerTargets& targets, Net& u);
  void add_near(const LayerTargets& targets, Net& u);
  void add_kept(const LayerTargets& targets, const Near& kept, Net& u) const;
  void add_self(const LayerTargets& targets, Net& u);

  LayerSources sources_;
  std::unique_ptr<LayerMedium> medium_ = std::make_unique<UnboundedFluid>();
  std::optional<ClusterSums> clusters_;  // not set if far sums are direct
  std::vector<int> fundamental_sites_;   // targets in the tree of clusters
  int part_ = 0, parts_ = 1;             // part of the far sums that this rank computes, and number of parts, see share()
  std::vector<int> everybody_;           // rows whose far sums share() divides into parts
};

}  // namespace tanktread::stokes
