#pragma once
// A capsule, drop or rigid body among others.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "membrane/laws.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"
#include "stokes/layer.hpp"
#include "system/solids/rigid_motion.hpp"

namespace tanktread::coupling {

/// What drives a rigid body: force and torque on it, about the centre of its volume; or it moves as prescribed.
struct Rigid {
  bool prescribed = false;
  RigidMotion motion;                                  ///< as prescribed
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< otherwise
};

/// What a particle is made of. Its rows of the stacked nets are those of `block`.
struct Particle {
  const spline::Space* space = nullptr;  ///< its own; outlives the system
  spline::Block block;
  double viscosity_ratio = 1;                 ///< lambda
  double radius = 1;                          ///< R_C
  membrane::Material material;
  stokes::Measure measure = stokes::Measure::reference;  ///< of its weak load: (3.7) or (3.6); any of a rigid body
  std::string interface_motion = "material";  ///< of the control points of a drop
  double interface_speed = 0;                 ///< of its relaxing motion, length/time
  std::optional<double> kept_volume;          ///< V0 to be kept, where it is not that of the initial net: on another mesh

  /// In addition to elasticity and bending, on its own space. The work of loads on a rigid body is force and torque on it.
  std::vector<std::shared_ptr<membrane::Load>> loads;
  std::optional<Rigid> rigid;                 ///< of a body that does not deform; it has no fluid, no membrane and no interface

  bool slides() const { return interface_motion != "material"; }
};

/// Where particles lie that are stacked in their order.
void place(std::span<Particle> particles);

/// The materials of all their elements, equal ones once.
membrane::Materials materials(std::span<const Particle> particles);

/// Returns what their loads are measured on.
stokes::Measure measure(std::span<const Particle> particles);

/// Returns for each element whether loads are measured on the present surface there.
std::vector<bool> measured_on_present(std::span<const Particle> particles);

/// Returns the net that loads are measured on: the rows of `x` or of `unstressed`, as each particle's measure says.
Net measured_net(std::span<const Particle> particles, const Net& unstressed, const Net& x);

/// The factor of the particle's double layer, 1 - lambda; -1 of a rigid body, whose density is w of (2.23).
double viscosity_contrast(const Particle& particle);

/// The same of each of their control points.
Eigen::VectorXd viscosity_contrasts_of_points(std::span<const Particle> particles);

/// The same of each of their elements; none where all are 0.
std::vector<double> viscosity_contrasts(std::span<const Particle> particles);

}  // namespace tanktread::coupling
