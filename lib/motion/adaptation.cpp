#include "motion/adaptation.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"

namespace tanktread::motion {

void AdaptationOptions::declare(deck::Section& section) {
  section.key("enabled", enabled, "refine the mesh as the particle deforms (P-37)");
  section.key("indicator", indicator, deck::Choice{"error", "variation"},
              "what is looked at: estimated `error`s (1.5) against tolerances, or the `variation` of fields against references (P-37)");
  for (double* length : {&surface_tolerance, &minimum_length, &coarsening_tolerance}) *length *= radius;
  if (indicator == "variation") reference_length = 0.35 * radius, limit_aspect_ratio = 2.5, order = 1;
  section.key("surface tolerance", surface_tolerance, deck::positive(), "length",
              "`error`: largest estimated error of the surface on an element; the default is in R_C");
  section.key("load tolerance", load_tolerance, deck::positive(), "force/length^2",
              "`error`: largest estimated error of the load per present area; if not given, the load is not looked at");
  section.key("reference length", reference_length, deck::positive(), "length",
              "L_ref: longest element where nothing varies; 0.35 R_C if not given");
  section.key("reference curvature variation", reference_curvature_variation, deck::positive(), "1/length^2",
              "chi_ref; if not given, curvature is not looked at");
  section.key("reference traction variation", reference_traction_variation, deck::positive(), "force/length^3",
              "T_ref; if not given, traction is not looked at");
  section.key("reference velocity variation", reference_velocity_variation, deck::positive(), "1/time",
              "V_ref; if not given, velocity is not looked at");
  section.key("limit aspect ratio", limit_aspect_ratio, deck::at_least(1), "1",
              "D_ref: an element that is longer than this times its width is cut; 2.5 if not given");
  section.key("order", order, deck::positive(), "1", "kappa: how strongly a variation above its reference shortens elements; 1 if not given");
  section.key("film resolution", film_resolution, deck::positive(), "1",
              "among several particles: longest element beside a film, over the square root of its width times R_C; 0.7 if not given. Halvings "
              "beside a film end with `levels` only");
  section.key("minimum length", minimum_length, deck::positive(), "length", "L_min: no shorter element is cut; the default is in R_C");
  section.key("interval", interval, deck::at_least(1), "steps", "accepted steps between two looks at the mesh");
  section.key("levels", levels, deck::between(0, 8), "1", "how often an element of the first mesh may be halved in a direction");
  section.key("largest number of points", largest_number_of_points, deck::at_least(56), "1",
              "no mesh has more control points: only the most urgent cuts are made, and in the end none");
  section.key("coarsen", coarsen, "take cuts back where they are no longer needed");
  section.key("coarsening margin", coarsening_margin, deck::between(0.01, 1), "1", "part of every limit below which a doubled element must stay");
  section.key("coarsening tolerance", coarsening_tolerance, deck::positive(), "length",
              "largest change of a surface by one coarsening; the default is in R_C");
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
      if (given) throw UserError(std::string("Adaptation/") + name + " belongs to Adaptation/indicator `variation`, but that is `error`.");
  } else if (load_tolerance) {
    throw UserError("Adaptation/load tolerance belongs to Adaptation/indicator `error`, but that is `variation`.");
  }
  if (minimum_length >= first_length)
    throw UserError(
        formatted("Adaptation/minimum length must be below the length of the elements that the run starts with, %.3g, or nothing is ever "
                  "cut, but is %.3g.",
                  first_length, minimum_length));
  if (largest_number_of_points <= first_points)
    throw UserError("Adaptation/largest number of points must be above the " + std::to_string(first_points) +
                    " that the run starts with, or nothing is ever cut, but is " + std::to_string(largest_number_of_points) + ".");
}

AdaptationOptions AdaptationOptions::coarser(double factor) const {
  AdaptationOptions result = *this;
  result.surface_tolerance *= factor;
  for (std::optional<double>* limit : {&result.film_resolution, &result.load_tolerance, &result.reference_length, &result.limit_aspect_ratio})
    if (*limit) **limit *= factor;
  return result;
}

namespace {

/// L_ref min{1, (phi_ref / phi)^kappa}.
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

}  // namespace

std::vector<spline::Mark> marks(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options) {
  std::vector<spline::Mark> found;
  for (size_t e = 0; e < metrics.size(); ++e) {
    bool cut[2];
    for (int a = 0; a < 2; ++a) {
      const surface::MidLine& line = metrics[e].along[a];
      cut[a] = line.length > options.minimum_length &&
               (line.length > allowed_length(line, options) || metrics[e].aspect_ratio(a) > options.limit_aspect_ratio.value());
    }
    if (cut[0] || cut[1]) found.push_back({static_cast<int>(e), cut[0], cut[1]});
  }
  return found;
}

std::vector<spline::Merge> merges(const std::vector<surface::ElementMetrics>& metrics, const AdaptationOptions& options) {
  std::vector<spline::Merge> found;
  for (size_t e = 0; e < metrics.size(); ++e) {
    bool merge[2];
    for (int a = 0; a < 2; ++a) {
      const surface::MidLine& line = metrics[e].along[a];
      merge[a] = 2 * line.length < options.coarsening_margin * allowed_length(line, options) &&
                 2 * metrics[e].aspect_ratio(a) < options.coarsening_margin * options.limit_aspect_ratio.value();
    }
    // Both at once keeps the aspect ratio, whatever it would be in between.
    const surface::ElementMetrics& m = metrics[e];
    if (!merge[0] && !merge[1] && std::max(m.aspect_ratio(0), m.aspect_ratio(1)) < options.coarsening_margin * options.limit_aspect_ratio.value())
      merge[0] = merge[1] = 2 * m.along[0].length < options.coarsening_margin * allowed_length(m.along[0], options) &&
                            2 * m.along[1].length < options.coarsening_margin * allowed_length(m.along[1], options);
    if (merge[0] || merge[1]) found.push_back({static_cast<int>(e), merge[0] ? 1 : 0, merge[1] ? 1 : 0});
  }
  return found;
}

namespace {

double longest(double width, const AdaptationOptions& options) { return options.film_resolution.value() * std::sqrt(width * options.radius); }

}  // namespace

void add_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
               std::vector<spline::Mark>& marks) {
  std::vector<spline::Mark> found;
  auto marked = marks.begin();
  for (int e = 0; e < static_cast<int>(lengths.size()); ++e) {
    const auto k = static_cast<size_t>(e);
    const double most = longest(widths[k], options);
    spline::Mark mark{e, lengths[k][0] > most, lengths[k][1] > most};
    if (marked != marks.end() && marked->element == e) mark.s |= marked->s, mark.t |= marked->t, ++marked;
    if (mark.s || mark.t) found.push_back(mark);
  }
  marks = std::move(found);
}

void keep_films(const std::vector<std::array<double, 2>>& lengths, const std::vector<double>& widths, const AdaptationOptions& options,
                std::vector<spline::Merge>& merges) {
  for (spline::Merge& merge : merges) {
    const auto k = static_cast<size_t>(merge.element);
    const double most = options.coarsening_margin * longest(widths[k], options);
    if (2 * lengths[k][0] > most) merge.s = 0;
    if (2 * lengths[k][1] > most) merge.t = 0;
  }
  std::erase_if(merges, [](const spline::Merge& merge) { return merge.s == 0 && merge.t == 0; });
}

namespace {

/// Largest estimated error over its tolerance.
double excess(const surface::Errors& errors, const AdaptationOptions& options) {
  const double surface = errors.surface / options.surface_tolerance;
  return options.load_tolerance ? std::max(surface, errors.load / *options.load_tolerance) : surface;
}

}  // namespace

std::vector<spline::Mark> marks(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options) {
  std::vector<spline::Mark> found;
  for (size_t e = 0; e < resolution.size(); ++e) {
    bool cut[2];
    for (int a = 0; a < 2; ++a) cut[a] = resolution[e][a].length > options.minimum_length && excess(resolution[e][a].errors, options) > 1;
    if (cut[0] || cut[1]) found.push_back({static_cast<int>(e), cut[0], cut[1]});
  }
  return found;
}

std::vector<spline::Merge> merges(const std::vector<std::array<surface::Resolution, 2>>& resolution, const AdaptationOptions& options) {
  std::vector<spline::Merge> found;
  for (size_t e = 0; e < resolution.size(); ++e) {
    int merge[2];
    for (int a = 0; a < 2; ++a) merge[a] = excess(resolution[e][a].merged, options) < options.coarsening_margin;
    if (merge[0] || merge[1]) found.push_back({static_cast<int>(e), merge[0], merge[1]});
  }
  return found;
}

}  // namespace tanktread::motion
