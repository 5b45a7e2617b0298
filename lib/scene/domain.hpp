#pragma once
// The lattice that a scene repeats on: `Domain/*` of the deck.

#include <optional>
#include <string>
#include <vector>

#include "base/columns.hpp"
#include "base/types.hpp"
#include "deck/forward.hpp"
#include "stokes/flow/flow_options.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread {

class Rejections;
struct Scene;

struct DomainOptions {
  bool present = false;  ///< whether the scene repeats at all; nothing else counts without

  std::string periodic = "x1 x2 x3";    ///< directions in which it does
  std::optional<std::vector<double>> side_lengths;  ///< of a box, three; with a duct its period alone; none: lattice vectors are given
  std::optional<Mat3> lattice_vectors;  ///< rows; those of directions that do not repeat count for nothing

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other or are missing, and for a flow that the lattice cannot follow. `duct`: the name of
  /// the duct that repeats, or none.
  void check(const stokes::FlowOptions& flow, const std::string& duct) const;

  void reject(const Scene& scene, Rejections& to) const;  ///< what a lattice excludes in the scene

  /// Number of directions in which the scene repeats.
  int directions() const;

  /// The cell at the start; nothing where the scene does not repeat.
  std::optional<stokes::PeriodicCell> cell() const;

 private:
  Mat3 vectors() const;
  void check_duct(const std::string& duct) const;
};

/// Data of the lattice for one row.
struct DomainRow {
  Mat3 cell = Mat3::Zero();  ///< columns: the vectors of the cell
  double volume_fraction = 0, relative_viscosity = 1;
  Mat3 stress = Mat3::Zero();  ///< that the particles add to the mean stress (6.9)
  Eigen::Vector2d normal_stress_differences = Eigen::Vector2d::Zero();  ///< in the axes of the plane of the flow
  Vec3 pressure_gradient = Vec3::Zero();

  /// Sets all but `cell` (6.9), (6.10) from volume and stresslet of all particles together, and their force on the fluid. `plane`: rows, the axes of
  /// the plane of the flow.
  void set_stress(const Scene& scene, const stokes::PeriodicCell& of, const Mat3& plane, double volume, const Mat3& stresslet, const Vec3& force);

  void add_columns(const Scene& scene, Columns& to) const;
};

}  // namespace tanktread
