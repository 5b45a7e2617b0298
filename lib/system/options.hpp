#pragma once
// Options of the conservation of volume, and of the motion of control points along an interface.

#include <optional>
#include <string>
#include <vector>

#include "deck/forward.hpp"

namespace tanktread::coupling {

/// Volume constraint. `flux`: zero net flux in every evaluation (2.8). `exact`: in addition, the volume is restored after every step. `none`: no
/// constraint.
enum class VolumeConservation { exact, flux, none };

inline const std::vector<std::string> volume_constraints{"exact", "flux", "none"};  ///< words for VolumeConservation in decks

/// Options `Volume/*` of the deck: how the volume of the particle is conserved.
struct VolumeOptions {
  VolumeConservation constraint = VolumeConservation::exact;

  bool constrained() const { return constraint != VolumeConservation::none; }  ///< true if velocities conserve the volumes (2.8)

  void declare(deck::Section& section);
};

/// Motion of the control points along an interface. `material`: with the fluid. `normal`: with the fluid in the normal direction, and
/// tangentially with the rigid motion W of the shape (4.14). `relaxed`: in addition tangentially so that elements keep their shape.
enum class MeshMotion { material, normal, relaxed };

inline const std::vector<std::string> mesh_motions{"material", "normal", "relaxed"};  ///< words for MeshMotion in decks

/// Options `Interface/*` of the deck: tangential motion of the control points along an interface. Without a membrane this motion is arbitrary.
struct InterfaceOptions {
  std::optional<MeshMotion> motion;  ///< if not set: `relaxed` for a surface tension, `material` otherwise
  double relaxation = 1;             ///< dimensionless speed of `relaxed`: the mesh moves like an elastic membrane of capillary number 1/relaxation

  void declare(deck::Section& section);
};

}  // namespace tanktread::coupling
