#pragma once
// Options of the motion of control points along an interface.

#include <optional>
#include <string>

#include "deck/forward.hpp"

namespace tanktread::coupling {

/// Options `Interface/*` of the deck: tangential motion of the control points along an interface. Without a membrane this motion is arbitrary.
struct InterfaceOptions {
  /// Motion of the control points. material: with the fluid; normal: only normal to the surface; relaxed: with the fluid in the normal direction, and
  /// tangentially so that elements keep their shape. If not set: relaxed for a surface tension, material otherwise.
  std::optional<std::string> motion;
  double relaxation = 1;  ///< relaxation speed of the mesh, which moves like an elastic surface at capillary number 1/relaxation

  void declare(deck::Section& section);
};

}  // namespace tanktread::coupling
