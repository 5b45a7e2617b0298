#pragma once
// A run that goes near an edge where its method stops working says so, once an edge, with what to change in the deck. The edges are those of
// tests/stability/README.md.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/body.hpp"
#include "scene/scene.hpp"
#include "surface/bezier_points.hpp"
#include "surface/quality.hpp"

namespace tanktread {

/// What a finished step is judged by. Lengths and times in the deck's units.
struct StepFindings {
  double time = 0, step = 0;
  double smallest_tension = 0, compressed_area = 0;  ///< as in the series
  double volume_error = 0;
  double jacobian_ratio = 1, aspect_ratio = 1;  ///< surface::Quality
  double element = 1;                           ///< mean size, the square root of the area over the elements
  std::optional<double> gap;                    ///< to the wall of a tube
};

/// A sentence for the user, and what it is about: one of a kind is enough.
struct Warning {
  std::string kind, sentence;
};

class Warnings {
 public:
  /// What a resumed run goes on with.
  struct Memory {
    double waves = 0;            ///< e-folds by which the shortest waves can have grown
    int limited = 0;             ///< of the latest steps, how many were as long as stability allows
    std::vector<Warning> said;  ///< so far
  };

  explicit Warnings(const Scene& scene) : scene_(scene) {}

  /// Whether there was none of this kind before; it counts as said from now on.
  bool fresh(const Warning& warning);

  /// Sentences that this step adds.
  std::vector<std::string> sentences(const StepFindings& signs);

  const Memory& memory() const { return memory_; }
  void remember(Memory memory) { memory_ = std::move(memory); }

 private:
  std::string choice() const;
  std::string compression(const StepFindings& signs);
  std::string stiffness(const StepFindings& signs);
  std::string fold(const StepFindings& signs) const;
  std::string stretch(const StepFindings& signs) const;
  std::string gap(const StepFindings& signs) const;
  std::string volume(const StepFindings& signs) const;

  const Scene& scene_;
  Memory memory_;
};

/// Stiffness rho of an elastic membrane on elements of size h, 1/time: (4.5) with the mean of the viscosities, or that of waves that are bent.
double stiffness(const Scene& scene, double h);

/// The quality of a shape. Throws RunFailure where an element is folded or a control point is no number. Ranks share the elements; all throw.
/// Collective.
surface::Quality soundness(const surface::BezierMap& map, const Net& x, const coupling::Ranks& ranks);

}  // namespace tanktread
