#pragma once
// Medium of a scene: boundaries of the fluid that change the kernels of all layers.

#include <memory>
#include <string>

#include "base/types.hpp"
#include "deck/parts.hpp"
#include "stokes/medium/layer_medium.hpp"

namespace tanktread::stokes {

class AmbientFlow;

/// Boundaries of the fluid that are not meshed: the kernels G and T of the layers are replaced by kernels that satisfy the conditions on them. For
/// points x and x0 in the fluid, the kernel must be self-adjoint, G_ij(x, x0) = G_ji(x0, x), and the integral of G n over a closed surface must be 0.
/// A PlaneWall is an example. A scene without a medium of this kind is in unbounded fluid, in a duct, or on a lattice.
class Medium {
 public:
  virtual ~Medium() = default;

  /// Returns the terms that the medium adds to one layer, for the kernel of `sources`. `by_clusters`: whether the layer evaluates its far sums by
  /// clusters.
  virtual std::unique_ptr<LayerMedium> in_layer(const LayerSources& sources, bool by_clusters) const = 0;

  virtual bool contains(const Vec3& x) const = 0;  ///< returns whether x is in the fluid

  /// Returns why an ambient flow does not satisfy the conditions on the boundaries, as a sentence for the user; empty if it satisfies them.
  virtual std::string refusal(const AmbientFlow& flow) const = 0;

  /// Returns whether x -> c + S (x - c), S = diag(signs), maps the fluid onto itself for every centre c. The default is true only for the identity.
  virtual bool keeps(const Vec3& signs) const { return signs == Vec3::Ones(); }
};

/// Media that a program adds, by name.
using UserMedia = deck::Parts<std::shared_ptr<const Medium>()>;

/// Returns the first row of `at` that the medium does not contain; -1 if there is none. The medium may be null.
inline Eigen::Index first_outside(const Medium* medium, const Net& at) {
  for (Eigen::Index i = 0; medium && i < at.rows(); ++i)
    if (!medium->contains(at.row(i).transpose())) return i;
  return -1;
}

/// Returns whether the medium contains all rows of `at`. Without a medium (null), it does.
inline bool contains(const Medium* medium, const Net& at) { return first_outside(medium, at) < 0; }

}  // namespace tanktread::stokes
