#pragma once
// Warnings when a run comes close to a limit of its method. Each limit gives one warning, with the key of the deck to change. The limits are
// documented in tests/stability/README.md.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/body.hpp"
#include "scene/scene.hpp"
#include "surface/bezier_points.hpp"
#include "surface/quality.hpp"

namespace tanktread {

/// Data of a finished step from which warnings are derived. Lengths and times are in the deck's units.
struct StepFindings {
  double time = 0, step = 0;
  std::vector<double> smallest_tension, compressed_area;  ///< columns of the same names, one value per deforming particle, in the order of the deck
  double volume_error = 0;
  double jacobian_ratio = 1, aspect_ratio = 1, tilt = 0;  ///< surface::Quality
  double element = 1;                           ///< mean element size: the square root of (area divided by number of elements)
  std::optional<double> gap;                    ///< gap to a wall

  StepFindings() = default;

  /// Reads the data from a row of the results. `particle_scene`: scene of the first deforming particle.
  StepFindings(const ParticleScene& particle_scene, const Columns& row, const surface::Quality& quality, int n_elements);
};

/// Warning for the user, and its kind. Each kind is shown only once.
struct Warning {
  std::string kind, sentence;
};

/// Returns the warnings that follow from the deck, at the start of a run or a search: about choices with known errors or costs, surface fields of an
/// earlier run that are not used and snapshots that are left out.
std::vector<Warning> first_warnings(const Scene& scene);

class Warnings {
 public:
  /// Data with which a resumed run continues.
  struct Memory {
    /// estimated growth of unresolved waves on compressed membranes so far: logarithm of their amplitude ratio. In each step, the membrane on which
    /// they grow fastest counts
    double waves = 0;
    int limited = 0;             ///< number of consecutive steps, up to the latest, whose size was limited by stability
    std::vector<Warning> shown;  ///< warnings shown so far
  };

  explicit Warnings(const Scene& scene);

  /// Returns true if no warning of this kind was shown before, and records it as shown.
  bool fresh(const Warning& warning);

  /// Returns the warnings to show after this step. Each kind is returned only once in a run.
  std::vector<Warning> of_step(const StepFindings& signs);

  const Memory& memory() const { return memory_; }
  void remember(Memory memory) { memory_ = std::move(memory); }

 private:
  std::string compression(const StepFindings& signs);
  std::string stiffness(const StepFindings& signs);
  std::string fold(const StepFindings& signs) const;
  std::string stretch(const StepFindings& signs) const;
  std::string tip(const StepFindings& signs) const;
  std::string gap(const StepFindings& signs) const;
  std::string volume(const StepFindings& signs) const;

  std::vector<ParticleScene> deforming_;  // the particles that deform, in the order of the deck
  ParticleScene scene_;                   // the first of them; the first particle if all are rigid
  Memory memory_;
};

/// Returns the stiffness of an elastic membrane on elements of size h, 1/time: the larger of two rates of the shortest waves on the mesh, by in-plane
/// deformation (4.5) and by bending. Both use the mean viscosity of the inner and the outer fluid.
double stiffness(const ParticleScene& particle_scene, double h);

/// Computes the quality of the mesh in the shape x. Throws RunFailure on all ranks if an element is folded or a control point is NaN. The ranks share
/// the elements. Collective.
surface::Quality soundness(const surface::BezierMap& map, const Net& x, const coupling::Ranks& ranks);

}  // namespace tanktread
