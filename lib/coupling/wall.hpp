#pragma once
// What depends on a tube's wall alone, made once a run.

#include <functional>
#include <optional>
#include <vector>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "coupling/ranks.hpp"
#include "quadrature/options.hpp"
#include "stokes/cap.hpp"
#include "stokes/layer.hpp"
#include "surface/closest_points.hpp"
#include "surface/symmetry.hpp"
#include "surface/tube_wall.hpp"

namespace tanktread::coupling {

/// The single layer of the wall on itself, assembled by rows and factored; the inlet. Without the viscosity; nets in the wall's frame.
/// The rows are shared out, the factors are on every rank: 72 bytes a pair of control points each.
///
/// With a symmetry, which all that is asked for has, only rows of fundamental points are assembled, and the others' columns added to theirs (4.12).
class Wall {
 public:
  /// Collective, like apply's replication of rows, whose time counts as an exchange among `phases`, if there are any; they outlive this.
  Wall(const surface::TubeWall& wall, const quadrature::Options& quadrature, Phases* phases = nullptr,
       const surface::Symmetry& symmetry = surface::Symmetry());

  const surface::TubeWall& surface() const { return surface_; }
  const surface::Symmetry& symmetry() const { return symmetry_; }
  const std::vector<int>& own() const { return own_; }  ///< rows of this rank, among the fundamental ones
  const Net& sites() const { return sites_; }           ///< collocation points
  const Ranks& ranks() const { return ranks_; }  ///< of these rows; the others are their images
  stokes::Layer& layer() { return layer_; }  ///< of the wall, at points off it
  const stokes::Cap& inlet() const { return inlet_; }

  Net apply(const Net& f) const;    ///< A f, A_iB = (1 / 8 pi) int G(x, x_i) N_B dG
  Net solve(const Net& rhs) const;  ///< A^-1 rhs

  const Net& inlet_column() const { return inlet_column_; }  ///< c of the inlet at the collocation points
  const Net& pumped() const { return pumped_; }              ///< A^-1 c: the traction of the open, empty tube with a unit of pressure drop

  /// int N_A c dG and int N_A e1 dG for every A: what a traction does to the flow rate through the inlet, and to the axial force.
  Net flow_weights() const;
  Net force_weights() const;

  /// Of the surface of a channel, for distances.
  const surface::ElementBoxes& boxes() const { return *boxes_; }

  stokes::Evaluations evaluations() const;

 private:
  Net weights(const std::function<Vec3(const Vec3&)>& field) const;
  Eigen::MatrixXd folded() const;

  surface::TubeWall surface_;
  surface::Symmetry symmetry_;
  std::optional<surface::Patches> patches_;
  std::optional<surface::ElementBoxes> boxes_;
  std::vector<int> own_;
  Ranks ranks_;
  stokes::Layer layer_;
  stokes::Cap inlet_;
  Net sites_, inlet_column_, pumped_;
  stokes::Rows<double> rows_;
  DenseFactors factors_;  // of A
  stokes::Evaluations assembly_;
};

}  // namespace tanktread::coupling
