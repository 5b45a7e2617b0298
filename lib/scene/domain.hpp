#pragma once
// Periodicity or medium of a scene: options `Domain/*` of the deck.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "base/types.hpp"
#include "deck/forward.hpp"
#include "stokes/flow/flow_options.hpp"
#include "stokes/medium/medium.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread {

struct ParticleScene;
struct SharedOptions;

struct DomainOptions {
  bool present = false;  ///< true if the scene is periodic; otherwise only `kind` and `medium` are used

  std::string kind = "lattice";  ///< "lattice", or the name of a registered medium
  const stokes::UserMedia* registered = nullptr;  ///< media that the program has added, with keys in `Domain/<kind>`; null if there are none
  std::shared_ptr<const stokes::Medium> medium;   ///< the registered medium of the scene; null if `kind` is "lattice"

  std::string periodic = "x1 x2 x3";    ///< periodic directions
  std::optional<std::vector<double>> side_lengths;  ///< three side lengths of a box, or the period of a duct; not set if lattice vectors are given
  std::optional<Mat3> lattice_vectors;  ///< lattice vectors as rows; rows of directions that are not periodic are ignored

  void declare(deck::Section& section);

  /// Throws UserError if the flow does not satisfy the conditions of the registered medium, if keys contradict each other or are missing, if the
  /// lattice vectors span no cell, or if `Flow/type` is `duct` without a duct. `duct`: section that describes a periodic duct, `Tube` or `Channel`;
  /// empty without a duct.
  void check(const stokes::FlowOptions& flow, const std::string& duct) const;

  void reject(const ParticleScene& particle_scene, Rejections& to) const;  ///< adds the choices of the scene that contradict a lattice

  /// Returns the number of periodic directions.
  int directions() const;

  /// Returns the periodic cell at the start of the run; nothing if the scene is not periodic.
  std::optional<stokes::PeriodicCell> cell() const;

 private:
  void declare_medium(deck::Section& section);
  void reject_medium(const ParticleScene& particle_scene, Rejections& to) const;
  /// Returns true if the flow changes the lattice vectors. The amplitude is taken as 1, and the time dependence `Flow/history` is ignored.
  bool deforms(const stokes::FlowOptions& flow) const;
  Mat3 vectors() const;
  void check_duct(const std::string& duct) const;
  void reject_duct(const std::string& duct, Rejections& to) const;
};

/// Throws UserError if the flow, in any of its directions over time, does not satisfy the conditions of a medium. `name`: section or choice of the
/// deck that gives the medium.
void check_flow(const stokes::FlowOptions& flow, const stokes::Medium& medium, const std::string& name);

/// Data of the lattice for one row of the results.
struct DomainRow {
  Mat3 cell = Mat3::Zero();  ///< lattice vectors of the cell as columns
  double volume_fraction = 0, relative_viscosity = 1;
  Mat3 stress = Mat3::Zero();  ///< symmetric part of the contribution of the particles to the mean stress (6.9), without its trace
  /// normal stress differences S_aa - S_bb and S_bb - S_cc of the stress S = `stress`. Axes a and b are in the plane of the flow, c is its normal; in
  /// simple shear, a is the direction of the flow and b the direction of its gradient
  Eigen::Vector2d normal_stress_differences = Eigen::Vector2d::Zero();
  Vec3 pressure_gradient = Vec3::Zero();

  /// Computes all data except `cell`, by (6.9) and (6.10), from the total volume, the total stresslet and the total force of the particles on the
  /// fluid. `of`: periodic cell. `plane`: the axes a, c and b of `normal_stress_differences` as rows. `gradient`: velocity gradient of the flow at
  /// this time. The relative viscosity is NaN if the rate of strain is zero at this time.
  void set_stress(double viscosity, const Mat3& gradient, const stokes::PeriodicCell& of, const Mat3& plane, double volume, const Mat3& stresslet,
                  const Vec3& force);

  void add_columns(const SharedOptions& shared, Columns& to) const;
};

}  // namespace tanktread
