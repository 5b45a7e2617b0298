#pragma once
// Layer potentials of spline surfaces: what they do to the fluid on them and off them.

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

/// Area to which the density of a single layer refers: unstressed area (3.7), present area (3.6), or one of them for each element (`set_reference`).
enum class Measure { reference, current, by_element };

/// Rows of a dense operator: of doubles where systems are solved with them, of floats where the Jacobian keeps them in fewer bits still.
template <class Real>
using Rows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Control points, some a target: point[first[k]] .. point[first[k + 1] - 1] are those of target k.
struct NearPoints {
  std::vector<std::size_t> first{0};
  std::vector<int> point;
};

/// Rows of a net as vectors.
inline std::vector<Vec3> rows_of(const Net& net, std::span<const int> rows) {
  std::vector<Vec3> all;
  for (const int i : rows) all.push_back(net.row(i).transpose());
  return all;
}

/// How images of surfaces that repeat count.
struct Repetition {
  bool assembled = false;  ///< assembled rows hold the images too, but for the smooth rest (PeriodicSum), which `assemble_rest` adds
  std::array<Vec3, 2> across{Vec3::Constant(1e300), Vec3::Constant(-1e300)};  ///< lowest and highest coordinates of targets, in the cell's axes
};

/// One layer of spline surfaces p, open or closed, at targets x0 on or off them, without the viscosity, of a density with control values f_B:
///
///   single:  u(x0) = sum_p (k_p / 8 pi) int_p G(x, x0) f dG                                 f = sum_B f_B N_B               (2.1)
///   double:  u(x0) = sum_p (k_p / 8 pi) int_p (f_j(x) - f_j(x0)) T_ijk(x, x0) n_k dG        n out of the surface            (2.2)
///
/// In the double layer f(x0) is the density at a target on the surface, so that no principal value is taken: of its own surface this is k times the
/// principal value plus f/2, and rigid motions of all give 0. A target off the surfaces takes away what it is given, by default nothing: of a closed
/// surface that it is outside of, a constant gives nothing (2.3).
///
/// A far sum over Gauss nodes is taken of all panels, one by one or by clusters (TreeSum), to the tolerance. Panels that a target is close to or lies
/// on then get rules of their own (NearField, SelfField) in its place, to the tolerance relative to the surface they belong to. A row depends on the
/// shape only, not on the other rows asked for. Under the rule `desingularised` Gauss nodes are all there is: what is singular in the single layer is
/// subtracted by two identities of a closed surface, int G n dG = 0 and that of the flow (n0.r) f_t, after Klaseboer, Sun & Chan, J. Fluid
/// Mech. 696, 2012 (our choice of the flow).
class Layer {
 public:
  enum class Kernel { single_layer, double_layer };

  /// `sites`: all targets are on the surfaces, as the space's `collocation` is; none: all are off them. `factor`: k of each element; 1
  /// where there are none.
  Layer(Kernel kernel, const spline::Space& space, const Sites& sites, const quadrature::Options& options, std::vector<double> factor = {});

  /// Sets the unstressed surface, which Measure::reference needs. Its areas are kept at all far nodes and self points. `present`: for each element,
  /// whether Measure::by_element means the present area there; otherwise it means the unstressed one.
  void set_reference(const Net& unstressed, std::vector<bool> present = {});

  /// States that all shapes and densities to come are of this symmetry, and all targets fundamental sites. Where far sums of a single layer are
  /// taken by clusters, those are made of fundamental panels F only, for the others do to a target what these do to its images:
  ///
  ///   u(x_i) = sum over images g of S_g u_F(g x_i),   S_g = diag(signs)                                                      (2.19)
  void set_symmetry(const surface::Symmetry& symmetry);

  /// States that the surfaces repeat as `cell` says, so that G and T are those of PeriodicKernel. A double layer of three periods has the pressure
  /// that grows along with them beside, by which it leaves the mean velocity over the cell, that inside of the surfaces included, as it is,
  ///
  ///   T_ijk = T^P_ijk - (8 pi/V) delta_jk (x - x_p)_i,   x_p a point of surface p,                                              (2.28)
  ///
  /// and int T n is that of (2.3). Again for each cell of one that deforms. What is assembled leaves images out unless `how` says otherwise.
  void repeat(const PeriodicCell& cell, const Repetition& how = {});

  /// Sets which of the points off the surfaces to come, rows from `first` on, see the images of a lattice without the surfaces themselves.
  void see_images_only(int first) { lattice_.images_only = first; }

  /// States that there is a plane wall, which all shapes to come are in front of: G and T are those that vanish on it, (2.35) and (2.36). Not on a
  /// lattice. What is assembled of near control points alone leaves the wall out.
  void set_wall(const PlaneWall& wall);

  /// Shares the far sums of the sites `everybody`, where they are taken by clusters, among callers 0 .. parts - 1: from now on `apply` fills these
  /// rows with what adds up to the layer over all callers; near and singular panels are counted by the caller whose targets they concern.
  void share(int part, int parts, std::vector<int> everybody);
  bool shared() const { return !everybody_.empty(); }

  /// Whether far sums are taken by clusters, so that applying is faster than assembling for a few products.
  bool by_clusters() const { return tree_.has_value(); }

  /// Takes the shape, good for any number of densities, and what those of a single layer are measured on.
  void place(const Net& x, Measure measure = Measure::current);

  /// Rows `sites` of u, shape (number of sites, 3), for the density with control values f.
  void apply(const Net& f, std::span<const int> sites, Net& u);

  /// What the near rules of points off the surfaces give beyond the far sum, for any density: 6 Bernstein moments for each point and close panel.
  struct Near {
    std::vector<std::size_t> first;  ///< of target k, in `panels`
    std::vector<int> panels;
    std::vector<double> moments;
  };

  /// For densities that are many, at the same points, in the same order, of the shape that is placed.
  Near near(const Net& at, std::span<const int> targets);

  /// Rows `targets` of u, shape of `at`, at points off the surfaces with rows `at`. `kept`: near(at, targets), or nothing.
  void apply(const Net& f, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr);

  /// The same with constants `f0` (a row a point) taken from f: with the density nearby the answer outside of a closed surface is the same (2.3), and
  /// the integrand is smaller. Double layer.
  void apply(const Net& f, const Net& f0, const Net& at, std::span<const int> targets, Net& u, const Near* kept = nullptr);

  /// A of u_i = sum_B A_iB f_B: three rows a target, in the order of `sites` or `targets`; shape (3 targets, 3 N).
  void assemble(std::span<const int> sites, Rows<float>& a);
  void assemble(std::span<const int> sites, Rows<double>& a);
  void assemble(const Net& at, std::span<const int> targets, Rows<float>& a);
  void assemble(const Net& at, std::span<const int> targets, Rows<double>& a);

  /// Adds to rows of a single layer, at sites or at points, what the images that are not near do.
  void assemble_rest(std::span<const int> sites, Rows<double>& a);

  /// The same of what the wall adds alone.
  void assemble_images(std::span<const int> sites, Rows<double>& a);

  /// Of A only the blocks A_iB of near control points: entries[6 j + c], c = 11, 12, 13, 22, 23, 33, for near.point[j]. Single layer. Targets side
  /// by side should be neighbours: sixteen of them share the panels that carry their near points.
  void assemble(std::span<const int> sites, const NearPoints& near, std::vector<double>& entries);

  /// The shape at its far nodes: places, weights with areas (of the measure; single layer) and normals times areas (double layer).
  int n_nodes() const { return surface_.panels.n_nodes(); }
  const std::vector<double> (&nodes() const)[3] { return surface_.node; }
  const std::vector<double>& weights() const { return weight_; }
  const std::vector<double> (&normals() const)[3] { return normal_; }

  /// A field at the far nodes, and the transpose: int N_A g dG for every A, from what g times area is at the far nodes.
  void values(const Net& field, std::vector<double> (&value)[3]);
  Eigen::VectorXd moments(const std::vector<double>& g) const;

  /// Kernel evaluations of all calls so far, and where their time went: `setup`, `far`, `near`, `self`, `assembly`.
  const Evaluations& evaluations() const { return evaluations_; }
  const Phases& phases() const { return phases_; }

 private:
  /// Targets of one call, and where they are.
  struct Targets {
    std::span<const int> rows, far_rows;  ///< rows of u with near rules, and with far sums
    const Net& at;                        ///< places
    const Net& f0;                        ///< what is taken from the density of a double layer
    std::span<const int> in_tree;         ///< all targets that clusters are made of, ascending
    bool sites;                           ///< they are sites of the surfaces
    const Near* kept = nullptr;
  };
  template <class Real>
  class RowSums;

  /// Images of the surfaces; without a cell there are none.
  struct Lattice {
    std::optional<PeriodicCell> cell;
    Repetition how;
    int images_only = std::numeric_limits<int>::max();  // first of the targets that see images only
    std::optional<PeriodicSum> sum;
    std::vector<double> node[3];                // far nodes, moved into the cell
    std::vector<Vec3> near{Vec3::Zero()};       // lattice vectors to panels that a target may be close to
    std::vector<Vec3> rest_at;                  // targets in the cell
    std::vector<Mat3> rest_stress;              // response of the rest of the lattice to constant densities there
  };

  /// The unstressed surface.
  struct Reference {
    std::vector<double> bezier, weight;  // Bezier points; weights of the far nodes, areas included
    std::vector<bool> present;           // elements that Measure::by_element does not measure on it
  };

  bool single() const { return kernel_ == Kernel::single_layer; }
  bool on_reference(int e) const {
    return measure_ == Measure::reference || (measure_ == Measure::by_element && !reference_.present[static_cast<std::size_t>(e)]);
  }
  Precision precision() const { return surface_.options.far_in_single() ? Precision::single : Precision::full; }
  double factor(int e) const { return factor_.empty() ? 1 : factor_[static_cast<std::size_t>(e)]; }
  PointForces forces(const std::vector<double> (&x)[3]) const;
  Stresslets stresslets(const std::vector<double> (&x)[3]) const;
  void set_density(const Net& f);
  void scale(std::span<std::vector<double>> at_nodes) const;
  void integrate(const Targets& targets, Net& u);
  void add_far(const Targets& targets, Net& u);
  void place_in_cell();
  std::vector<Vec3> far_targets(const Targets& targets, std::span<const int> rows) const;
  const std::vector<double> (&far_places() const)[3] { return lattice_.cell ? lattice_.node : surface_.node; }
  void add_rest(const Targets& targets, Net& u);
  void add_rest(std::span<const std::vector<double>> carried, std::size_t n, const std::vector<Vec3>& at, Net& sums);
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
  std::optional<Measure> measure_;                                 // of the weights that are there
  Reference reference_;
  std::vector<double> bezier_f_;                                   // Bezier points of the density
  std::vector<double> weight_;                                     // of the far nodes, areas included
  std::vector<double> density_[3], normal_[3];                     // at far nodes: f, times the weight in a single layer; normal times area and k
  std::optional<TreeSum> tree_;                                    // where clusters are faster
  Lattice lattice_;
  std::optional<ImageSum> images_;                                 // in a plane wall
  std::vector<Mat3> image_stress_;                                 // what they take from values at the targets
  std::vector<int> fundamental_sites_, everybody_;                 // targets in the tree; rows that far sums are shared of; empty: they are not
  std::vector<Vec3> tree_at_;                                      // targets of the tree
  std::vector<int> tree_rows_;                                     // rows wanted of it; none: it is to be placed
  std::vector<double> stress_;                                     // 8 pi times the solid angle of the far nodes at the targets, six numbers each
  std::vector<double> moment_[6];                                  // of the far nodes: symmetric part of density times normal
  std::vector<Pack> point_weights_, scratch_;
  Evaluations evaluations_;
  Phases phases_;
};

}  // namespace tanktread::stokes
