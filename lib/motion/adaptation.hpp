#pragma once
// Where the mesh is to be cut and where cuts may be taken back.

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

/// Mesh adaptation: `Adaptation/*` of the deck. Lengths and fields in the deck's units, defaults of lengths before `declare` in R_C.
struct AdaptationOptions {
  double radius = 1;                                       ///< R_C; no key of the deck
  bool enabled = false;
  std::string indicator = "error";                         ///< `error` (1.5) or `variation` (P-37)
  double surface_tolerance = 4e-4;                         ///< of e(x), length
  std::optional<double> load_tolerance;                    ///< of e(phi), force/length^2; empty: not in use
  std::optional<double> reference_length;                  ///< L_ref; set for `variation`, as are the next five where they are in use
  std::optional<double> reference_curvature_variation;     ///< chi_ref, 1/length^2; empty: not in use
  std::optional<double> reference_traction_variation;      ///< T_ref, of the traction per current area, per length
  std::optional<double> reference_velocity_variation;      ///< V_ref, 1/time
  std::optional<double> limit_aspect_ratio;                ///< D_ref
  std::optional<double> order;                             ///< kappa
  std::optional<double> film_resolution;                   ///< longest element beside a film over sqrt(width x R_C); set where there are films
  double minimum_length = 0.035;                           ///< L_min, a floor under every cut
  int interval = 1;                                        ///< accepted steps between checks
  int levels = 4;                                          ///< how often an element of the first mesh may be halved in a direction
  int largest_number_of_points = 4000;                     ///< no mesh has more
  bool coarsen = false;
  double coarsening_margin = 0.7;                          ///< a doubled element must stay below this part of every limit
  double coarsening_tolerance = 1e-4;                      ///< largest change of either surface by one coarsening, length

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other, or that leave nothing to do on a first mesh of so many points with elements of
  /// this length.
  void check(int first_points, double first_length) const;

  /// The same with every limit (tolerances, longest element, aspect ratio) this many times as large.
  AdaptationOptions coarser(double factor) const;
};

/// Elements and directions that the rule wants to be cut (P-37), in the order of elements(mesh):
///
///   L_a > L_min  and  ( L_a > L_ref min{1, (phi_ref / phi_a)^kappa over the quantities in use}  or  L_a / L_b > D_ref )
std::vector<spline::Mark> marks(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options);

/// Elements that stay below `coarsening margin` of every limit of (P-37) when they are twice as long, in the directions in which they do.
std::vector<spline::Merge> merges(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options);

/// An element that is longer than `film resolution` times sqrt(width x R_C), width that of the film beside it, is cut; it is not merged where it
/// would be. `lengths`: along s and t, and widths, of elements(mesh). Marks and merges of the same element become one; L_min does not count.
void add_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
               std::vector<spline::Mark>& marks);
void keep_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
                std::vector<spline::Merge>& merges);

/// The same by estimated errors (1.5): cut along a where L_a > L_min and one of them is above its tolerance; merge where all those of the element
/// twice as long stay below `coarsening margin` of it.
std::vector<spline::Mark> marks(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options);
std::vector<spline::Merge> merges(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options);

}  // namespace tanktread::motion
