#include "motion/adaptation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"

namespace tanktread::motion {

void AdaptationOptions::declare(deck::Section& section) {
  section.key("enabled", enabled, "whether the surface mesh is refined where and when the particle's deformation requires it");
  section.key(
      "indicator", indicator, deck::Choice{"error", "variation"},
      "criterion for the refinement of the mesh. `error`: estimated errors on an element compared with tolerances (1.5). `variation`: "
      "changes of curvature, traction and velocity along an element compared with reference values (1.4), as by Maestre et al. (2017)");
  for (double* length : {&surface_tolerance, &minimum_length, &coarsening_tolerance}) *length *= radius;
  if (indicator == "variation") reference_length = 0.35 * radius, limit_aspect_ratio = 2.5, order = 1;
  section.key("surface tolerance", surface_tolerance, deck::positive(), "length",
              "largest allowed error, estimated on each element, of the position of the surface, for Adaptation/indicator `error`; if not "
              "given, 4e-4 R_C (4e-4 for radius 1), where R_C is the radius of the sphere with the particle's volume. Divided by R_C, it is "
              "also the tolerance of the relative error of the surfactant concentration and of the error of a viscoelastic membrane's strain");
  section.key("load tolerance", load_tolerance, deck::positive(), "force/length^2",
              "largest allowed error, estimated on each element, of the membrane load per current area, for Adaptation/indicator `error`; "
              "if not given, load errors cause no refinement");
  section.key("reference length", reference_length, deck::positive(), "length",
              "largest allowed length L_ref of elements where fields are uniform, for Adaptation/indicator `variation`; default 0.35 R_C, "
              "where R_C is the radius of the sphere with the particle's volume");
  section.key(
      "reference curvature variation", reference_curvature_variation, deck::positive(), "1/length^2",
      "threshold chi_ref for Adaptation/indicator `variation`: where the mean curvature changes along an element by more than chi_ref per "
      "length, elements are made shorter (see Adaptation/order). If not given, curvature causes no refinement");
  section.key("reference traction variation", reference_traction_variation, deck::positive(), "force/length^3",
              "threshold T_ref for Adaptation/indicator `variation`: where the traction (membrane load per current area) changes along an "
              "element by more than T_ref per length, elements are made shorter (see Adaptation/order). If not given, the traction causes no "
              "refinement");
  section.key("reference velocity variation", reference_velocity_variation, deck::positive(), "1/time",
              "threshold V_ref for Adaptation/indicator `variation`: where the velocity changes along an element by more than V_ref per "
              "length, elements are made shorter (see Adaptation/order). If not given, the velocity causes no refinement");
  section.key("limit aspect ratio", limit_aspect_ratio, deck::at_least(1), "1",
              "ratio of length to width of an element above which its length is halved, for Adaptation/indicator `variation`; "
              "2.5 if not given");
  section.key("order", order, deck::positive(), "1",
              "exponent kappa for Adaptation/indicator `variation`: where curvature, traction or velocity varies r > 1 times as much as its "
              "reference value, the largest allowed length of elements is Adaptation/reference length / r^kappa; 1 if not given");
  section.key(
      "film resolution", film_resolution, deck::positive(), "1",
      "largest allowed length of elements next to a thin film of fluid (between two particles, a particle and a wall, or periodic images), "
      "divided by sqrt(film width x R_C), where R_C is the radius of the sphere with the particle's volume; 0.7 if not given, 0.5 for "
      "rigid bodies in the section Particles. Adaptation/levels limits this refinement, Adaptation/minimum length does not");
  section.key("minimum length", minimum_length, deck::positive(), "length",
              "element length L_min below which elements are not refined; if not given, 0.035 R_C (0.035 for radius 1), where R_C is "
              "the radius of the sphere with the particle's volume");
  section.key("interval", interval, deck::at_least(1), "steps",
              "number of accepted time steps between two checks of the mesh for refinement");
  section.key("levels", levels, deck::between(0, 8), "1",
              "largest number of times that an element of the initial mesh may be halved in each direction: with 4, to 1/16 of its length");
  section.key(
      "largest number of points", largest_number_of_points, deck::at_least(56), "1",
      "largest number of control points of the surface mesh. Near this limit only the most urgent refinements are made, at the limit none");
  section.key("coarsen", coarsen, "whether elements are merged again where their refinement is not needed any more");
  section.key("coarsening margin", coarsening_margin, deck::between(0.01, 1), "1",
              "safety factor of coarsening: elements are merged only if the merged element, of twice the length, stays below this fraction of "
              "every tolerance and limit of refinement. With smaller values, merged elements are less often refined again");
  section.key("coarsening tolerance", coarsening_tolerance, deck::positive(), "length",
              "largest allowed displacement of the surface by one coarsening of the mesh; default 1e-4 R_C, where R_C is the radius of the "
              "sphere with the particle's volume");
  if (!enabled) section.without_effect_except("enabled", "without Adaptation/enabled");
}

void AdaptationOptions::check(int first_points, double first_length) const {
  if (!enabled) return;
  if (indicator == "error") {
    for (const auto& [name, given] : {std::pair{"reference curvature variation", reference_curvature_variation},
                                      {"reference traction variation", reference_traction_variation},
                                      {"reference velocity variation", reference_velocity_variation},
                                      {"reference length", reference_length},
                                      {"limit aspect ratio", limit_aspect_ratio},
                                      {"order", order}})
      if (given)
        throw UserError(std::string("Adaptation/") + name +
                        " belongs to Adaptation/indicator `variation`, but Adaptation/indicator is `error`.");
  } else if (load_tolerance) {
    throw UserError("Adaptation/load tolerance belongs to Adaptation/indicator `error`, but Adaptation/indicator is `variation`.");
  }
  if (minimum_length >= first_length)
    throw UserError(formatted(
        "Adaptation/minimum length must be below the length of the initial elements, %.3g, so that elements can be refined, but is %.3g.",
        first_length, minimum_length));
  if (largest_number_of_points <= first_points)
    throw UserError("Adaptation/largest number of points must be above the " + std::to_string(first_points) +
                    " control points of the initial mesh, so that elements can be refined, but is " +
                    std::to_string(largest_number_of_points) + ".");
}

AdaptationOptions AdaptationOptions::coarser(double factor) const {
  AdaptationOptions result = *this;
  result.surface_tolerance *= factor;
  for (std::optional<double>* limit : {&result.film_resolution, &result.load_tolerance, &result.reference_length, &result.limit_aspect_ratio})
    if (*limit) **limit *= factor;
  return result;
}

namespace {

/// Returns the largest allowed length of an element: the smallest value of L_ref min{1, (phi_ref / phi)^kappa} over all quantities phi whose
/// reference variation phi_ref is set (1.4).
double allowed_length(const surface::MidLine& line, const AdaptationOptions& options) {
  double factor = 1;
  const auto heed = [&](const std::optional<double>& reference, double variation) {
    if (reference && variation > *reference) factor = std::min(factor, std::pow(*reference / variation, options.order.value()));
  };
  heed(options.reference_curvature_variation, line.curvature);
  heed(options.reference_traction_variation, line.traction);
  heed(options.reference_velocity_variation, line.velocity);
  return options.reference_length.value() * factor;
}

/// Returns the ratio of an estimated error to its tolerance; 0 if the deck does not limit this error.
double excess(surface::Criterion criterion, double error, const AdaptationOptions& options) {
  switch (criterion) {
    case surface::Criterion::surface: return error / options.surface_tolerance;
    case surface::Criterion::load: return options.load_tolerance ? error / *options.load_tolerance : 0;
    case surface::Criterion::fields: return error * options.radius / options.surface_tolerance;
  }
  throw std::logic_error("no criterion of refinement has the number " + std::to_string(static_cast<int>(criterion)));
}

/// Returns the largest ratio of an estimated error to its tolerance.
double excess(const surface::Errors& errors, const AdaptationOptions& options) {
  std::array<double, surface::n_criteria> ratios;
  for (std::size_t k = 0; k < ratios.size(); ++k) ratios[k] = excess(static_cast<surface::Criterion>(k), errors.of[k], options);
  return *std::ranges::max_element(ratios);
}

/// Returns the largest allowed length of an element next to a film of this width.
double longest(double width, const AdaptationOptions& options) { return options.film_resolution.value() * std::sqrt(width * options.radius); }

/// Returns the entries (marks for refinement, or merges) of all elements 0 .. n - 1 for which wanted(element, direction) is true along s (direction
/// 0) or along t (1).
template <class Entry, class Wanted>
std::vector<Entry> collected(std::size_t n, const Wanted& wanted) {
  std::vector<Entry> found;
  for (std::size_t e = 0; e < n; ++e) {
    const bool along_s = wanted(e, 0), along_t = wanted(e, 1);
    if (along_s || along_t) found.push_back({static_cast<int>(e), along_s, along_t});
  }
  return found;
}

}  // namespace

std::vector<spline::Mark> marks(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options) {
  return collected<spline::Mark>(metrics.size(), [&](std::size_t e, int a) {
    const surface::MidLine& line = metrics[e].along[a];
    return line.length > options.minimum_length &&
           (line.length > allowed_length(line, options) || metrics[e].aspect_ratio(a) > options.limit_aspect_ratio.value());
  });
}

std::vector<spline::Merge> merges(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options) {
  const double margin = options.coarsening_margin;
  const auto slender = [&](double ratio) { return ratio >= margin * options.limit_aspect_ratio.value(); };
  const auto is_short = [&](const surface::MidLine& line) { return 2 * line.length < margin * allowed_length(line, options); };
  const auto alone = [&](std::size_t e, int a) { return is_short(metrics[e].along[a]) && !slender(2 * metrics[e].aspect_ratio(a)); };
  // Merging in both directions at once keeps the aspect ratio of an element. Therefore it is allowed even if merging in only one direction would
  // exceed the limit on the aspect ratio.
  const auto both = [&](const surface::ElementMetrics& m) {
    return !slender(std::max(m.aspect_ratio(0), m.aspect_ratio(1))) && is_short(m.along[0]) && is_short(m.along[1]);
  };
  return collected<spline::Merge>(metrics.size(),
                                  [&](std::size_t e, int a) { return alone(e, a) || (!alone(e, 1 - a) && both(metrics[e])); });
}

std::vector<spline::Mark> marks(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options) {
  return collected<spline::Mark>(resolution.size(), [&](std::size_t e, int a) {
    return resolution[e][a].length > options.minimum_length && excess(resolution[e][a].errors, options) > 1;
  });
}

std::vector<spline::Merge> merges(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options) {
  return collected<spline::Merge>(resolution.size(), [&](std::size_t e, int a) {
    return excess(resolution[e][a].merged, options) < options.coarsening_margin;
  });
}

void add_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
               std::vector<spline::Mark>& marks) {
  std::vector<std::array<bool, 2>> marked(lengths.size());
  for (const spline::Mark& mark : marks) marked[mark.element] = {mark.s, mark.t};
  marks = collected<spline::Mark>(lengths.size(),
                                  [&](std::size_t e, int a) { return marked[e][a] || lengths[e][a] > longest(widths[e], options); });
}

void keep_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
                std::vector<spline::Merge>& merges) {
  for (spline::Merge& merge : merges) {
    const std::array<double, 2>& length = lengths[merge.element];
    const double most = options.coarsening_margin * longest(widths[merge.element], options);
    if (2 * length[0] > most) merge.s = 0;
    if (2 * length[1] > most) merge.t = 0;
  }
  std::erase_if(merges, [](const spline::Merge& merge) { return merge.s == 0 && merge.t == 0; });
}

}  // namespace tanktread::motion
