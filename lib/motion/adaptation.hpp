#pragma once
// Criteria for mesh adaptation: which elements to refine and which refinements to undo.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "spline/refinement.hpp"
#include "surface/metrics.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

/// Options of mesh adaptation, `Adaptation/*` of the deck. Lengths and fields are in the units of the deck. declare() multiplies default lengths by
/// R_C.
struct AdaptationOptions {
  double radius = 1;                                       ///< particle radius R_C; not a key of the deck
  bool enabled = false;
  std::string indicator = "error";                         ///< `error` (1.5) or `variation` (1.4)
  double surface_tolerance = 4e-4;                         ///< tolerance of the estimated error of the surface position (1.5), length
  std::optional<double> load_tolerance;                    ///< tolerance of the estimated load error (1.5), force/length^2; if empty, not used
  /// L_ref, reference length of an element; this and the next five members are set only if the indicator is `variation`
  std::optional<double> reference_length;
  /// chi_ref, reference variation of the mean curvature, 1/length^2; empty: no refinement by curvature
  std::optional<double> reference_curvature_variation;
  std::optional<double> reference_traction_variation;      ///< T_ref, reference variation of the traction (force per current area), force/length^3
  std::optional<double> reference_velocity_variation;      ///< V_ref, 1/time
  std::optional<double> limit_aspect_ratio;                ///< D_ref, largest aspect ratio of an element
  std::optional<double> order;                             ///< kappa, exponent of the ratio of variations in (1.4)
  /// largest allowed length of an element next to a thin film of fluid, divided by sqrt(film width x R_C); set if there are films
  std::optional<double> film_resolution;
  static constexpr double default_film_resolution = 0.7;   ///< default of film_resolution; 0.5 for rigid bodies among several particles
  double minimum_length = 0.035;                           ///< L_min: shorter elements are not refined
  int interval = 1;                                        ///< accepted steps between checks
  int levels = 4;                                          ///< largest number of bisections of an element of the initial mesh in one direction
  int largest_number_of_points = 4000;                     ///< upper limit for every mesh
  bool coarsen = false;
  double coarsening_margin = 0.7;                          ///< merged elements must stay below this fraction of every refinement limit
  double coarsening_tolerance = 1e-4;  ///< largest allowed displacement of the current or unstressed surface by one coarsening, length

  void declare(deck::Section& section);

  /// Returns whether the error or the variation of the load causes refinement.
  bool limits_load() const { return load_tolerance || reference_traction_variation; }

  /// Throws UserError, with a one-sentence message, if keys contradict each other, or if they allow no refinement of an initial mesh with this number
  /// of control points and this element length.
  void check(int first_points, double first_length) const;

  /// Returns the options for a coarser mesh: the tolerances of the surface and of the load, the reference length, the largest aspect ratio and the
  /// film resolution are multiplied by this factor.
  AdaptationOptions coarser(double factor) const;
};

/// Returns the elements and directions to refine (1.4), in the order of elements(mesh). An element is refined along the direction a if
///
///   L_a > L_min  and  ( L_a > L_ref min{1, (phi_ref / phi_a)^kappa}  or  L_a / L_b > D_ref )
///
/// L_a is the length of the element along a, L_b its length along the other direction, and phi_a the variation of a quantity phi along a. The minimum
/// is over all quantities whose reference variation phi_ref is set. L_min, L_ref, kappa and D_ref are members of AdaptationOptions.
std::vector<spline::Mark> marks(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options);

/// Returns the elements and directions to coarsen. An element is merged along a direction if the merged element, of twice the length, stays below
/// `coarsening margin` times every limit of marks().
std::vector<spline::Merge> merges(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options);

/// Marks elements that are longer than `film resolution` times sqrt(width x R_C), where width is the width of the adjacent film. This limit also
/// holds for elements shorter than L_min. Earlier marks are kept. `lengths` (of elements, along s and t) and `widths` (of films) are in the order of
/// elements(mesh).
void add_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
               std::vector<spline::Mark>& marks);
/// Removes merges whose merged element would be longer than `coarsening margin` times the limit of add_films().
void keep_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
                std::vector<spline::Merge>& merges);

/// Returns the elements and directions to refine, from estimated errors (1.5). An element is refined along a direction if its length along this
/// direction is greater than L_min and one of its errors exceeds the tolerance of this error.
std::vector<spline::Mark> marks(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options);
/// Returns the elements and directions to coarsen, from estimated errors (1.5). An element is merged into an element of twice the length if all
/// errors of the merged element are below `coarsening margin` times their tolerances.
std::vector<spline::Merge> merges(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options);

}  // namespace tanktread::motion
