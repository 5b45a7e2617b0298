#pragma once
// What depends on a tube's wall alone, made once a run.

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "stokes/flow/cap.hpp"
#include "stokes/layer.hpp"
#include "surface/closest_points.hpp"
#include "surface/geometry.hpp"
#include "surface/symmetry.hpp"
#include "surface/tube_wall.hpp"
#include "system/ranks.hpp"
#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// Rows of the inverses of the wall's operator between few neighbours, five by five: what f_i is where rhs is theirs alone.
class WallPatches {
 public:
  /// Of these control points; `layer`: of the wall at its collocation points, placed.
  WallPatches(const surface::TubeWall& wall, stokes::Layer& layer, const std::vector<int>& points);

  /// Rows of f for these points.
  void apply(const Net& rhs, Net& f) const;

 private:
  struct Patch {
    int point;
    std::vector<int> neighbours;
    Eigen::Matrix<double, 3, Eigen::Dynamic> row;
  };
  std::vector<Patch> patches_;
};

/// The single layer of the wall on itself, assembled by rows and factored; the inlet. Without the viscosity; nets in the wall's frame.
/// Making the rows is shared out, the factors are on every rank: 72 bytes a pair of control points.
///
/// With a symmetry, which all that is asked for has, only rows of fundamental points are assembled, and the others' columns added to theirs (4.12).
///
/// Where the factors would be too large the system is solved by GMRES each time, with products by clusters, preconditioned by small patches and by
/// what the solves before tell (2.24).
///
/// A velocity that vanishes at the collocation points of a wall has one sign between them, so that fluid leaks through. On the wall of a channel
/// the leak would be a part of the flow rate, of a train it would grow with the pressure from copy to copy: there what vanishes is the mean around
/// each of them, (2.39).
///
/// One period of a wall that repeats has the kernels of one period, no ends, and periodic tractions f, control values a row per site. A constant
/// pressure q n moves nothing: that its flux vanishes, int f.n dG = 0, is added to A.
class Wall {
 public:
  /// Collective, like apply's replication of rows, whose time counts as an exchange among `phases`, if there are any; they outlive this.
  /// `solver`: factored, iterative, or auto, the latter where factors take more than `most_bytes`.
  Wall(const surface::TubeWall& wall, const quadrature::Options& quadrature, Phases* phases = nullptr,
       const surface::Symmetry& symmetry = surface::Symmetry(), const std::string& solver = "factored");

  static constexpr double most_bytes = 4e9;
  static bool iterates(const std::string& solver, double unknowns) {
    return solver == "iterative" || (solver == "auto" && 8 * unknowns * unknowns > most_bytes);
  }
  bool iterates() const { return patches_of_rows_.has_value(); }

  const surface::TubeWall& surface() const { return surface_; }
  const surface::Symmetry& symmetry() const { return symmetry_; }
  const std::vector<int>& own() const { return own_; }  ///< rows of this rank, among the fundamental ones
  const Net& sites() const { return sites_; }           ///< collocation points

  /// Where velocities are taken that vanish on the wall: its collocation points; of a channel or a wall that repeats then the middles of elements.
  const Net& targets() const { return targets_; }
  const std::vector<int>& own_targets() const { return own_targets_; }  ///< those that rows of this rank need

  /// Right-hand side for `solve`, a row a collocation point, from what u is at the targets; rows that no rank needs are not read. Collective.
  Net collocated(const Net& u) const;

  /// The same of rows of an operator, three a collocation point of `sites`, from those that `assemble` fills for some targets.
  template <class Real>
  void collocate(std::span<const int> sites, const std::function<void(std::span<const int> targets, stokes::Rows<Real>& rows)>& assemble,
                 stokes::Rows<Real>& rows) const;

  const Ranks& ranks() const { return ranks_; }  ///< of these rows; the others are their images
  stokes::Layer& layer() { return layer_; }  ///< of the wall, at points off it, for control values on its space
  const stokes::Cap& inlet() const { return *inlet_; }  ///< of an open wall

  /// The lattice of a wall that repeats; nothing of an open one.
  const std::optional<stokes::PeriodicCell>& cell() const { return cell_; }

  /// Lowest and highest coordinates of the wall across, in the axes of the cell.
  std::array<Vec3, 2> across() const;

  /// Control values on the space from those of a traction f, one row per site, and the transpose.
  Net on_space(const Net& f) const { return cell_ ? Net(surface_.open_from_periodic * f) : f; }
  Net from_space(const Net& weights) const { return cell_ ? Net(surface_.open_from_periodic.transpose() * weights) : weights; }
  void from_space(stokes::Rows<float>& rows) const;  ///< columns of an operator, three per control value

  Net apply(const Net& f) const;    ///< A f, A_iB = (1 / 8 pi) int G(x, x_i) N_B dG, its means as of `collocated`
  Net solve(const Net& rhs) const;  ///< A^-1 rhs
  void forget_recycled() const;                 ///< discards what the preconditioner keeps from earlier solves

  /// What has with every rhs the product that `weights` has with solve(rhs). Of what is factored.
  Net solve_transposed(const Net& weights) const;

  const Net& inlet_column() const { return inlet_column_; }  ///< c of the inlet, collocated; of a wall that repeats zero
  const Net& pumped() const { return pumped_; }              ///< A^-1 c: the traction of the open, empty tube with a unit of pressure drop

  /// int N_A c dG and int N_A e1 dG for every A: what a traction does to the flow rate through the inlet, and to the axial force.
  Net flow_weights() const;
  Net force_weights() const;

  /// Flow rate along the duct, times mu, of a unit force along each axis at these points: c of the inlet (2.13); of a wall that repeats, for forces
  /// whose sum vanishes, -rho^2/(4 L) e1 with rho the distance from the axis x1                                                    (2.44)
  Net flow_of_forces(const Net& at) const;

  /// Flow rate of a unit strength of the double layer along each axis, at a point with normal n: of an open wall through the inlet; of one that
  /// repeats (x1 n - ((n.rho) e1 + n1 rho)/2)/L, for strengths without flux                                                         (2.45)
  Vec3 flow_of_double_layer(const Vec3& at, const Vec3& n) const;

  /// Of the surface of a channel, for distances.
  const surface::ElementBoxes& boxes() const { return *boxes_; }

  stokes::Evaluations evaluations() const;

 private:
  Net weights(const std::function<Vec3(const surface::Point&)>& field) const;
  std::vector<int> middles_around(int point) const;
  void add_middles();
  Eigen::MatrixXd assembled();
  Net iterated(const Net& rhs) const;
  bool has_middles() const { return surface_.channel.get() != nullptr; }
  void find_pressure();
  double share_of_middle(int point) const;
  Eigen::VectorXd fundamental(const Net& net) const;
  Net fundamental_net(const Eigen::VectorXd& numbers) const;

  surface::TubeWall surface_;
  surface::Symmetry symmetry_;
  std::optional<surface::Patches> patches_;
  std::optional<surface::ElementBoxes> boxes_;
  std::vector<int> own_, own_targets_;
  Ranks ranks_;
  std::optional<stokes::PeriodicCell> cell_;
  stokes::Layer layer_;
  std::optional<stokes::Cap> inlet_;
  Net sites_, targets_, inlet_column_, pumped_;
  Net pressure_, flux_;  // of a wall that repeats: w n at the sites, w a weight, and int N_A n dG
  std::unique_ptr<stokes::Layer> on_itself_;  // at the targets
  DenseFactors factors_;                      // of A, or what solves without them:
  std::optional<WallPatches> patches_of_rows_;
  std::unique_ptr<Krylov> krylov_;
  double tolerance_;  // of its residuals
};

}  // namespace tanktread::coupling
