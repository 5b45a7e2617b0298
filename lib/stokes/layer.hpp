#pragma once
// Layer potentials of spline surfaces, at targets on and off the surfaces.

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/kernels/kernels.hpp"
#include "stokes/layer_surface.hpp"
#include "stokes/medium/image_sum.hpp"
#include "stokes/medium/periodic_sum.hpp"
#include "stokes/sums/tree_sum.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// Area to which the density of a single layer refers: unstressed area (3.7), current area (3.6), or a choice between the two for each element
/// (`set_reference`).
enum class Measure { reference, current, by_element };

/// Dense matrix, stored row by row, for rows of an operator. Linear systems use double precision. The Jacobian uses single precision and rounds the
/// rows further (FrozenOperator).
template <class Real>
using Rows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// List of control points for each target: target k has point[first[k]] .. point[first[k + 1] - 1].
struct NearPoints {
  std::vector<std::size_t> first{0};
  std::vector<int> point;
};

/// Returns the given rows of a net (one point or vector per row) as vectors.
inline std::vector<Vec3> rows_of(const Net& net, std::span<const int> rows) {
  std::vector<Vec3> all;
  for (const int i : rows) all.push_back(net.row(i).transpose());
  return all;
}

/// Options for the periodic images of the surfaces on a lattice.
struct Repetition {
  bool assembled = false;  ///< true: assembled rows include the near images, and assemble_rest() adds all other images (PeriodicSum). false:
                           ///< assembled rows include no images
  std::array<Vec3, 2> across{Vec3::Constant(1e300), Vec3::Constant(-1e300)};  ///< lowest and highest lattice coordinates of targets off the
                                                                              ///< surfaces
};

/// Single or double layer potential of spline surfaces p, open or closed, at targets x0 on or off them. f_B are the control values of the density, dG
/// is the area element, and k_p is a factor per surface, by default 1. The viscosity is not included.
///
///   single:  u(x0) = sum_p (k_p / 8 pi) int_p G(x, x0) f dG                                 f = sum_B f_B N_B               (2.1)
///   double:  u(x0) = sum_p (k_p / 8 pi) int_p (f_j(x) - f_j(x0)) T_ijk(x, x0) n_k dG        n out of the surface            (2.2)
///
/// In the double layer, f(x0) is the density at a target on a surface, so that no principal value is needed. The contribution of the surface that
/// contains the target equals k_p times the sum of the principal value and f/2. If f is a rigid motion of all surfaces, u is 0. For a target off the
/// surfaces, f(x0) is a constant given by the caller, by default 0. This constant does not change u if the target is outside a closed surface (2.3).
///
/// The far-field sum over the Gauss nodes of all panels is evaluated to the tolerance, directly or by clusters (TreeSum). On panels that are close to
/// a target or contain it, near-singular or singular quadrature (NearField, SelfField) replaces the panel's terms of this sum. The tolerance of this
/// quadrature is relative to an integral over the panel's whole surface. The value at a target does not depend on which other targets are requested.
/// The quadrature rule `desingularised` uses only the Gauss nodes. This rule subtracts the singularity of the single layer by two identities of a
/// closed surface: the integral of G n is 0, and the boundary integral identity of the linear flow (n0.r) f_t, where n0 is the normal and f_t the
/// tangential density at the target. After Klaseboer, Sun & Chan, J. Fluid Mech. 696, 2012, who use a different flow.
class Layer {
 public:
  enum class Kernel { single_layer, double_layer };

  /// `sites`: targets on the surfaces, for example the space's `collocation`; if empty, all targets are off the surfaces. `factor`: factor k_p of
  /// (2.1) and (2.2) for each element; if empty, it is 1.
  Layer(Kernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options, std::vector<double> factor = {});

  /// Sets the unstressed surface, to whose area the densities refer with Measure::reference. The unstressed areas are stored for all far nodes and
  /// all points of singular rules. `present`: for each element, whether Measure::by_element selects the current area (true) or the unstressed area
  /// (false).
  void set_reference(const Net& unstressed, std::vector<bool> present = {});

  /// Sets the symmetry that all later shapes and densities have. All later targets must be fundamental sites (one site of each orbit). If the far sum
  /// of a single layer uses clusters, it is computed as the sum u_F over the fundamental panels only. The sum over all panels then follows from u_F
  /// at the images g x_i of each target x_i:
  ///
  ///   u(x_i) = sum over images g of S_g u_F(g x_i),   S_g = diag(+-1)                                                         (2.19)
  void set_symmetry(const surface::Symmetry& symmetry);

  /// Sets the lattice `cell` on which the surfaces repeat, so that G and T become the kernels of PeriodicKernel. Must be called again when the cell
  /// deforms. With three periods, a double layer includes an additional pressure linear in x. The double layer then does not change the mean velocity
  /// over the cell, including the volume inside the surfaces:
  ///
  ///   T_ijk = T^P_ijk - (8 pi/V) delta_jk (x - x_p)_i,   x_p a point of surface p.                                              (2.28)
  ///
  /// The integral of T n over a closed surface then has the same values as without a lattice (2.3). Assembled rows do not include images unless `how`
  /// requests them.
  void repeat(const PeriodicCell& cell, const Repetition& how = {});

  /// In later evaluations at targets off the surfaces, restricts the sums in rows `first` and higher to the images of the surfaces on the lattice. In
  /// these rows the surfaces themselves do not contribute.
  void see_images_only(int first) { lattice_.images_only = first; }

  /// Sets a plane wall; all later shapes must be in front of it. G and T become the kernels that vanish on the wall, (2.35) and (2.36). Not available
  /// on a lattice. The blocks assembled for near control points do not include the wall.
  void set_wall(const PlaneWall& wall);

  /// If far sums use clusters, divides the far sums at the sites `everybody` among the ranks 0 .. parts - 1; `part` is the number of this rank. Then
  /// `apply` computes only the share of this rank in the rows `everybody`. The caller must sum these rows over all ranks. Near-singular and singular
  /// quadrature is included only by the rank that requests the row.
  void share(int part, int parts, std::vector<int> everybody);
  bool shared() const { return !everybody_.empty(); }

  /// Returns whether far sums use clusters. If so, a few products are computed faster by `apply` than with assembled rows.
  bool by_clusters() const { return tree_.has_value(); }

  /// Sets the shape x, which is kept for any number of densities. `measure`: area to which the density of a single layer refers.
  void place(const Net& x, Measure measure = Measure::current);

  /// Computes rows `sites` of u for the density with control values f. `u`: shape (number of all sites, 3).
  void apply(const Net& f, std::span<const int> sites, Net& u);

  /// Corrections of the far sum by near-singular quadrature at points off the surfaces, for any density. For each pair of a point and a close panel,
  /// the corrections are stored as moments: 6 per Bernstein polynomial of the panel.
  struct Near {
    std::vector<std::size_t> first;  ///< for each target, index in `panels` at which the list of the target's close panels begins
    std::vector<int> panels;
    std::vector<double> moments;
  };

  /// Returns the corrections at points `at` for the current shape, to be reused for many densities with equal `at` and `targets`.
  Near near(const Net& at, std::span<const int> targets);

  /// Computes the layer potential at points off the surfaces: row i of u at the point `at.row(i)`, for each i in `targets`. u has the shape of `at`.
  /// `kept`: result of near(at, targets), or null.
  void apply(const Net& f, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr);

  /// Computes the double layer after a constant, row k of `f0`, is subtracted from f for target k. Outside a closed surface the result does not
  /// change (2.3), but the integrand is smaller if f0 is the density nearby.
  void apply(const Net& f, const Net& f0, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr);

  /// Assembles the matrix A of the layer potential u_i = sum_B A_iB f_B: three rows per target, in the order of `sites` or `targets`; shape (3 x
  /// number of targets, 3 x number of control points).
  void assemble(std::span<const int> sites, Rows<float>& a);
  void assemble(std::span<const int> sites, Rows<double>& a);
  void assemble(const Net& at, std::span<const int> targets, Rows<float>& a);
  void assemble(const Net& at, std::span<const int> targets, Rows<double>& a);

  /// Adds to the assembled rows `a` at `sites` the images of a periodic single layer that are not near (PeriodicSum).
  void assemble_rest(std::span<const int> sites, Rows<double>& a);

  /// Assembles only the blocks A_iB of near control points of a single layer: entries[6 j + c], c = 11, 12, 13, 22, 23, 33, for near.point[j].
  /// Consecutive targets should be neighbours, because targets are processed in groups of sixteen, and each group evaluates the panels around the
  /// near points of all its targets.
  void assemble(std::span<const int> sites, const NearPoints& near, std::vector<double>& entries);

  /// Return the far nodes of the current shape: their number, positions, weights (single layer) and normals (double layer). Weights and normals
  /// include the area of the node and the factor k_p of (2.1), (2.2).
  int n_nodes() const { return surface_.panels.n_nodes(); }
  const std::vector<double> (&nodes() const)[3] { return surface_.node; }
  const std::vector<double>& weights() const { return weight_; }
  const std::vector<double> (&normals() const)[3] { return normal_; }

  /// Evaluates a field, given by its control values, at the far nodes.
  void values(const Net& field, std::vector<double> (&value)[3]);
  /// Returns the integral of a function h times each basis function, the transpose of values(). `g`: h times area and quadrature weight at each far
  /// node.
  Eigen::VectorXd moments(const std::vector<double>& g) const;

  /// Returns the number of kernel evaluations since construction.
  const Evaluations& evaluations() const { return evaluations_; }
  /// Returns the computing times since construction, divided into `setup`, `far`, `near`, `self` and `assembly`, and further phases for a lattice or
  /// a wall.
  const Phases& phases() const { return phases_; }

 private:
  /// Targets of one evaluation of the layer: their positions, and the rows of the result to compute.
  struct Targets {
    std::span<const int> rows, far_rows;  ///< rows of u that get near-singular and singular quadrature, and rows that get far sums
    const Net& at;                        ///< positions
    const Net& f0;                        ///< for each target, the constant subtracted from the density of a double layer
    std::span<const int> in_tree;         ///< ascending indices of the targets that are in the tree of clusters
    bool sites;                           ///< true if the targets are sites of the surfaces, false if they are off the surfaces
    const Near* kept = nullptr;
  };
  template <class Real>
  class RowSums;

  /// Data for the images of the surfaces on a lattice; unused if no periodic cell is set.
  struct Lattice {
    std::optional<PeriodicCell> cell;
    Repetition how;
    int images_only = std::numeric_limits<int>::max();  // first row to which only images contribute, see see_images_only()
    std::optional<PeriodicSum> sum;
    std::vector<double> node[3];                // far nodes, moved into the cell
    std::vector<Vec3> near{Vec3::Zero()};       // lattice vectors of images whose panels may be close to a target
    std::vector<Vec3> rest_at;                  // targets at which rest_stress was computed: positions shifted by lattice vectors into the cell
    std::vector<Mat3> rest_stress;              // at the targets rest_at: double layer over all images except the near ones, column c for the
                                                // constant density e_c
  };

  /// The unstressed surface.
  struct Reference {
    std::vector<double> bezier, weight;  // bezier: Bezier points of the unstressed surface. weight: quadrature weights of this surface at the far
                                         // nodes, areas included
    std::vector<bool> present;           // used with Measure::by_element; one entry per element: true if the density is per current area of the
                                         // element, false if it is per unstressed area
  };

  bool single() const { return kernel_ == Kernel::single_layer; }
  bool on_reference(int e) const {
    return measure_ == Measure::reference || (measure_ == Measure::by_element && !reference_.present[static_cast<std::size_t>(e)]);
  }
  /// Returns the tolerance of the sum by clusters: for the single layer that of the deck, for the double layer half of it, with which the measured
  /// error of the double layer is a quarter of the deck's tolerance. In a double layer, `surface_.options` holds an eighth of the deck's tolerance.
  double tree_tolerance() const { return (single() ? 1 : 4) * surface_.options.tolerance; }
  Precision precision() const { return surface_.options.far_in_single() ? Precision::single : Precision::full; }
  double factor(int e) const { return factor_.empty() ? 1 : factor_[static_cast<std::size_t>(e)]; }
  void set_density(const Net& f);
  void integrate(const Targets& targets, Net& u);
  void add_far(const Targets& targets, Net& u);
  void place_in_cell();
  std::vector<Vec3> far_targets(const Targets& targets, std::span<const int> rows) const;
  const std::vector<double> (&far_places() const)[3] { return lattice_.cell ? lattice_.node : surface_.node; }
  void add_rest(const Targets& targets, Net& u);
  void place_rest(const std::vector<Vec3>& at);
  Vec3 pressure_along() const;
  Vec3 mean_density() const;
  template <class Values>
  void take_moments_of(const Values& f);
  void take_moments(const Vec3& mean);
  void take_constant_moments(int component);
  void place_tree(const Targets& targets);
  void add_by_clusters(const Targets& targets, Net& u);
  void add_forces_by_clusters(const Targets& targets, Net& u);
  void add_stresslets_by_clusters(const Targets& targets, Net& u);
  Vec3 beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, const Vec3& f0, long long& count);
  void add_kept(const Targets& targets, Net& u) const;
  void moments_beyond_far_sum(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments);
  void subtract_itself(const Targets& targets, Net& u);
  const Pack* area_weights_of(int e, const PointTable& table, SelfPair* pair);
  void panel_moments(int e, const PointTable& table, SelfPair* pair, const Vec3& at, double* moments);
  void add_images(const Targets& targets, Net& u);
  void add_near_images(const Targets& targets, Net& u);
  void take_image_stress();
  Vec3 beyond_image_sum(int e, const PointTable& table, const Vec3& below, const Vec3& at, const Vec3& f0);
  void image_moments(int e, const Vec3& at, std::vector<Mat3>& moments);
  template <class Real>
  void add_image_rows(std::span<const int> targets, const Net* at, Rows<Real>& a);
  Mat3 identities(int site) const;
  void subtract_identities(std::span<const int> sites, Net& u);
  template <class Real>
  void subtract_identities(std::span<const int> sites, Rows<Real>& a) const;
  void subtract_identities(std::span<const int> sites, const NearPoints& near, std::vector<double>& entries) const;
  template <class Real>
  void subtract_density_at_site(int site, Real* sums) const;
  template <class Real>
  void assemble_rows(std::span<const int> targets, const Net* at, Rows<Real>& a);

  Kernel kernel_;
  LayerSurface surface_;
  std::vector<double> factor_;
  std::optional<Measure> measure_;                                 // area of the current weight_
  Reference reference_;
  std::vector<double> bezier_f_;                                   // Bezier points of the density
  std::vector<double> weight_;                                     // quadrature weights of the far nodes, times area and the factor k_p of (2.1)
  std::vector<double> density_[3], normal_[3];                     // values at the far nodes. density_: density f (times weight_ in a single layer).
                                                                   // normal_: normal times quadrature weight, area and factor k_p of (2.2)
  std::optional<TreeSum> tree_;                                    // clusters for far sums; not set if direct sums are used
  Lattice lattice_;
  std::optional<ImageSum> images_;                                 // images in a plane wall
  std::vector<Mat3> image_stress_;                                 // for each target, the double layer of the images in the wall for the constant
                                                                   // densities e_1, e_2 and e_3, as columns
  std::vector<int> fundamental_sites_, everybody_;                 // fundamental_sites_: targets in the tree. everybody_: rows whose far sums share()
                                                                   // divides into parts
  std::vector<Vec3> tree_at_;                                      // targets of the tree
  std::vector<int> tree_rows_;                                     // rows that the tree computes; empty if the tree must be built anew
  std::vector<double> stress_;                                     // sum of T_ijk n_k over the far nodes at the targets, six components each
  std::vector<double> moment_[6];                                  // stresslet moments at the far nodes: symmetric part of density times normal
  std::vector<Pack> point_weights_, scratch_;
  Evaluations evaluations_;
  Phases phases_;
};

}  // namespace tanktread::stokes
