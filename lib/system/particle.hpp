#pragma once
// A capsule, drop or rigid body among several particles.

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
#include "system/options.hpp"
#include "system/rigid_motion.hpp"
#include "system/blocks/layout.hpp"

namespace tanktread::coupling {

/// Drive of a rigid body: the force and the torque on it about its centre of volume, or its prescribed motion.
struct RigidDrive {
  bool prescribed = false;
  RigidMotion motion;                                  ///< prescribed motion
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< given force and torque if the motion is not prescribed
};

/// Material and discretisation of a particle. `block` gives its rows in the control nets that stack the points of all particles.
struct Particle {
  std::string path;  ///< section of the particle in the deck, for messages
  const spline::Space* space = nullptr;  ///< space of this particle; outlives the system
  spline::Block block;
  double viscosity_ratio = 1;                 ///< lambda, viscosity of the inner fluid divided by mu
  double radius = 1;                          ///< R_C, radius of the sphere of equal volume
  membrane::Material material;
  stokes::Measure measure = stokes::Measure::reference;  ///< surface area to which the load (force per area) refers: unstressed (3.7) or current
                                                         ///< (3.6); not used for rigid bodies
  bool by_traction = false;  ///< whether the unknown on a rigid body is its traction (2.40) rather than the density w of a double layer (2.23). Equal
                             ///< for all rigid bodies, and false for other particles
  MeshMotion interface_motion = MeshMotion::material;  ///< motion of the control points of a drop along its interface
  double interface_speed = 0;                 ///< speed of the mesh relaxation of a drop, length/time
  bool interface_turns = true;                ///< true if the mesh of an elongated drop turns with its shape; false: it never turns as a whole
  std::optional<double> kept_volume;  ///< volume V0 to be conserved, for example after a change of mesh; if not set, the volume of the initial net

  /// Loads in addition to elasticity and bending, on `space`. For a rigid body the work of the loads gives the force and torque on it.
  std::vector<std::shared_ptr<membrane::Load>> loads;
  std::optional<RigidDrive> rigid;            ///< set for a body that does not deform; it has no inner fluid, no membrane and no interface

  bool slides() const { return interface_motion != MeshMotion::material; }
};

/// Difference between a particle on a lattice and its image in the cell.
struct CellShift {
  Vec3 position = Vec3::Zero();  ///< lattice vector: position of the particle minus position of the image
  Vec3 velocity = Vec3::Zero();  ///< ambient velocity at the particle minus ambient velocity at the image; 0 in a duct, whose flow is periodic
};

/// Sets the block of each particle: its rows in nets that stack all particles in this order.
void set_blocks(std::span<Particle> particles);

/// Returns the distinct materials of the particles and, if there are several, the index of the material of each element.
membrane::Materials materials(std::span<const Particle> particles);

/// Returns the area (unstressed or current) to which the loads of all particles refer; Measure::by_element if it is not the same for all particles.
stokes::Measure measure(std::span<const Particle> particles);

/// Returns, for each element, whether its load is per current area rather than per unstressed area.
std::vector<bool> loads_per_current_area(std::span<const Particle> particles);

/// Returns the net of the surface to whose area the loads (force per area) refer: for each particle, its rows of `x` if its loads are per current
/// area, otherwise its rows of `unstressed`.
Net measured_net(std::span<const Particle> particles, const Net& unstressed, const Net& x);

/// Returns the factor of the particle's double layer: 1 - lambda for a deformable particle. For a rigid body: -1 if the unknown is the double-layer
/// density w (2.23), 0 if the unknown is the traction (2.40).
double viscosity_contrast(const Particle& particle);

/// Returns the viscosity contrast of each element of all particles; empty if all are 0.
std::vector<double> viscosity_contrasts(std::span<const Particle> particles);

/// Returns the blocks of the unknowns on particles, one block per particle in their order.
std::vector<Block> blocks_of_particles(std::span<const Particle> particles);

/// Sets the rows of rigid bodies to 0.
void clear_rigid(std::span<const Particle> particles, Net& net);

/// The loads of all particles in addition to elasticity and bending, combined into one load on the stacked nets of shape (N, 3). A load may depend on
/// integrals over the whole surface (such as the area). Such a load returns this rank's contribution to these integrals in nets, called sum nets. The
/// caller sums the sum nets over ranks and symmetry images and passes them back. Several loads of one particle use consecutive sum nets. Loads of
/// different particles share a sum net, in which each particle uses its own rows. Uses no MPI.
class Loads {
 public:
  /// `elements`: elements that this rank integrates over, ascending.
  Loads(std::span<const Particle> particles, std::span<const int> elements);

  std::size_t n_sums() const { return n_sums_; }

  /// Adds the contributions of this rank's elements to dE/dx in `work`. Returns the contributions of these elements to the surface integrals that
  /// add_global_work() needs; the caller must sum them over all ranks.
  std::vector<Net> add_work(const Net& x, Net& work) const;
  void add_global_work(const Net& x, const std::vector<Net>& sums, Net& work) const;

  /// Returns the energy that the loads of particle p store in its membrane. `sums`: result of add_work(), summed over all ranks.
  double energy(const Net& x, const std::vector<Net>& sums, std::size_t p) const;
  /// Adds dE/dx to `work`, where E is the energy that loads store in the membrane. Integrates over all elements.
  void add_stored_work(const Net& x, Net& work) const;

  void linearise(const Net& x, const std::vector<Net>& sums);
  void add_tangent(const Net& dx, Net& change) const;
  void add_global_tangent(const Net& dx, Net& change) const;

 private:
  struct One {
    std::size_t particle;
    spline::Block block;
    std::vector<int> elements;  // elements of this rank, numbered from 0 within the particle
    std::shared_ptr<membrane::Load> load;
    std::size_t first_sum;

    std::vector<Net> own(const std::vector<Net>& sums) const;  // sum nets of this load, with the rows of its particle
  };
  std::vector<One> all_;
  std::size_t n_sums_ = 0;
};

}  // namespace tanktread::coupling
