#pragma once
// Contribution of the surroundings of the surfaces, such as a wall or periodic images, to a layer.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer_sources.hpp"

namespace tanktread::stokes {

/// Dense matrix, stored row by row, for rows of an operator. Linear systems use double precision. The Jacobian uses single precision and rounds the
/// rows further (FrozenOperator).
template <class Real>
using Rows = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns the given rows of a net (one point or vector per row) as vectors.
inline std::vector<Vec3> rows_of(const Net& net, std::span<const int> rows) {
  std::vector<Vec3> all;
  for (const int i : rows) all.push_back(net.row(i).transpose());
  return all;
}

/// List of control points for each target: target k has point[first[k]] .. point[first[k + 1] - 1].
struct NearPoints {
  std::vector<std::size_t> first{0};
  std::vector<int> point;
};

/// Targets of one evaluation of a layer: their positions, and the rows of the result to compute.
struct LayerTargets {
  std::span<const int> rows, far_rows;  ///< rows of the result that get near-singular and singular quadrature, and rows that get far sums
  const Net& at;                        ///< positions
  const Net& f0;                        ///< for each target, the constant subtracted from the density of a double layer
  std::span<const int> in_tree;         ///< ascending indices of the targets that are in the tree of clusters
  bool sites;                           ///< true if the targets are sites of the surfaces, false if they are off the surfaces
  int first_image_row;                  ///< first row to which only displaced images contribute, see Layer::apply
};

/// Medium of a layer: the fluid and the boundaries that the kernels of the layer take into account. A derived class adds the difference between its
/// kernels and those of free space, in up to three ways:
///
///   displaced images   copies of the surfaces by lattice vectors, with the kernel of free space, which the layer sums and integrates like the
///                      surfaces themselves: node_shifts(), panel_shifts(), nodes(), wrapped()
///   other terms        anything that the derived class sums or integrates itself: add(), add_row()
///   smooth remainder   of assembled rows that contain displaced images: add_remainder()
///
/// Order of calls: first set_sources() for each shape, then any other functions. One object belongs to one layer.
class LayerMedium {
 public:
  virtual ~LayerMedium() = default;

  /// Prepares the sums for the shape and the weights of `sources`.
  virtual void set_sources(const LayerSources& /*sources*/) {}

  /// Divides the far sums of add() among the ranks, see TreeSum::share, if shares_sums() is true.
  virtual void share(int /*part*/, int /*parts*/) {}
  /// Returns whether share() divides the far sums of add() among the ranks. If so, add() adds the part of this rank to the rows
  /// LayerTargets::far_rows, and the caller of the layer adds up the parts of all ranks. Otherwise, add() is called with far_rows equal to rows, and
  /// adds the sums over all nodes.
  virtual bool shares_sums() const { return false; }

  /// Displacements of the nodes() that are included in far sums. In far sums each node and each target is first moved by wrapped().
  virtual const std::vector<Vec3>& node_shifts() const { return itself_; }
  /// Displacements of the surfaces for which panels may be close to a target.
  virtual const std::vector<Vec3>& panel_shifts() const { return itself_; }
  /// Returns true if wrapped() shifts each position into the unit cell of a lattice. Nodes of one panel may then be far apart, and the symmetry of
  /// the surfaces is lost.
  virtual bool wraps() const { return false; }
  virtual Vec3 wrapped(const Vec3& x) const { return x; }
  virtual const NodeVectors& nodes(const LayerSources& sources) const { return sources.surface.node; }  ///< far nodes, wrapped
  /// Returns whether assembled rows include the displaced images.
  virtual bool rows_include_images() const { return false; }

  /// Adds to rows of u, which are later divided by 8 pi, all terms except the terms of displaced images with the kernel of free space.
  virtual void add(LayerSources& sources, const LayerTargets& targets, Net& u) = 0;

  /// Adds the terms of add() to assembled rows of the target x0: block[B] is the 3 x 3 block of control point B, before the division by 8 pi. Returns
  /// false if there are no such terms, without a change of `block`. Called by several threads for different targets if any_thread() is true.
  virtual bool add_row(LayerSources& sources, const Vec3& x0, std::vector<Mat3>& block) = 0;

  virtual bool any_thread() const { return false; }  ///< whether several threads may call add_row()

  /// Adds to assembled rows `a` of a single layer at `sites` the part of the kernel that rows_include_images() does not cover.
  virtual void add_remainder(const LayerSources& /*sources*/, std::span<const int> /*sites*/, Rows<double>& /*a*/) const {}

 private:
  std::vector<Vec3> itself_{Vec3::Zero()};
};

/// Unbounded fluid, the medium of a layer by default. It adds nothing to the kernels of free space.
class UnboundedFluid : public LayerMedium {
 public:
  void add(LayerSources& /*sources*/, const LayerTargets& /*targets*/, Net& /*u*/) override {}
  bool add_row(LayerSources& /*sources*/, const Vec3& /*x0*/, std::vector<Mat3>& /*block*/) override { return false; }
};

}  // namespace tanktread::stokes
