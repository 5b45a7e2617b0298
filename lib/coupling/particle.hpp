#pragma once
// A capsule or drop among others.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "membrane/material.hpp"
#include "spline/space.hpp"
#include "spline/stacked.hpp"

namespace tanktread::coupling {

/// What a particle is made of. Its rows of the stacked nets are those of `block`.
struct Particle {
  const spline::Space* space = nullptr;  ///< its own; outlives the system
  spline::Block block;
  double viscosity_ratio = 1;                 ///< lambda
  double radius = 1;                          ///< R_C
  membrane::Material material;
  std::string interface_motion = "material";  ///< of the control points of a drop
  double interface_speed = 0;                 ///< of its relaxing motion, length/time
  std::optional<double> kept_volume;          ///< V0 to be kept, where it is not that of the initial net: on another mesh

  bool slides() const { return interface_motion != "material"; }
};

/// Where particles lie that are stacked in their order.
void place(std::span<Particle> particles);

/// The materials of all their elements.
membrane::Materials materials(std::span<const Particle> particles);

/// 1 - lambda of each of their elements; none where all are 0.
std::vector<double> viscosity_contrasts(std::span<const Particle> particles);

}  // namespace tanktread::coupling
