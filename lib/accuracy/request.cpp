#include "accuracy/request.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

#include "base/errors.hpp"
#include "base/text_file.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::accuracy {

namespace {

constexpr std::array<std::string_view, 35> without_error{
    "time", "time_step", "step_error", "rejected_steps", "iterations", "evaluations", "assemblies", "solver_iterations", "velocity_iterations",
    "wall_seconds", "n_control_points", "first_of_gap", "second_of_gap", "particle_at_wall", "refit_error", "volume_error", "power_residual",
    "disturbance_flux", "force_imbalance", "cap_velocity", "pressure_drop_by_flux", "pressure_drop_by_force", "drag_error",
    "drag_error_of_traction", "torque_error", "pressure_l2_error", "normal_l2_error", "fold", "unstable_modes", "kernel_evaluations",
    "surfactant_mass", "volume_fraction", "shape_velocity", "normal_velocity", "contact_force"};

[[noreturn]] void refuse_form(const std::string& text, const std::string& why) {
  throw UserError("Accuracy/requests: " + deck::in_quotes(deck::shortened(text, 80)) + " " + why +
                  "; a request is [<particle>/]<series>[@end|@mean]=<value>[%], for example taylor_inertia=1e-3 or velocity_x1@end=0.1%.");
}

/// Returns the requests in a comma-separated list.
std::vector<Request> requests_of(const std::string& texts) {
  std::vector<Request> all;
  for (std::size_t at = 0; at <= texts.size();) {
    const std::size_t comma = std::min(texts.find(',', at), texts.size());
    all.push_back(request_of(texts.substr(at, comma - at)));
    at = comma + 1;
  }
  return all;
}

}  // namespace

std::string Request::text() const {
  const char* part = of == Of::end ? "@end" : of == Of::mean ? "@mean" : "";
  return series + part + "=" + deck::number_text(relative ? 100 * value : value) + (relative ? "%" : "");
}

Request request_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse_form(text, "has no value");
  Request request;
  request.series = trimmed(text.substr(0, equals));
  std::string number = trimmed(text.substr(equals + 1));
  if (const std::size_t at = request.series.find('@'); at != std::string::npos) {
    const std::string part = request.series.substr(at + 1);
    if (part != "end" && part != "mean") refuse_form(text, "asks for @" + part + ", which is neither @end nor @mean");
    request.of = part == "end" ? Of::end : Of::mean;
    request.series = trimmed(request.series.substr(0, at));
  }
  if (request.series.empty()) refuse_form(text, "names no series");
  if (number.ends_with('%')) request.relative = true, number = trimmed(number.substr(0, number.size() - 1));
  const auto [rest, error] = std::from_chars(number.data(), number.data() + number.size(), request.value);
  if (error != std::errc() || rest != number.data() + number.size() || !(request.value > 0) || request.value > 1e300)
    refuse_form(text, "needs a positive number after the sign =, in the unit of the series and without its name");
  if (request.relative) request.value /= 100;
  return request;
}

void Options::declare(deck::Section& section) {
  std::string texts;
  section.key("requests", texts, deck::Choice{},
              "requested accuracies, separated by commas, each `[<particle>/]<series>[@end|@mean]=<value>[%]` (required). The estimated "
              "error of the output series must not exceed the value: its largest error over the run, or with `@end` the error of its last "
              "value, or with `@mean` the error of its average over the run. With `%` the value is relative to the largest magnitude of "
              "the series. The program chooses meshes and tolerances, and repeats the run on finer levels until all requests are met");
  section.key(
      "wall-clock limit", wall_clock_limit, deck::positive(), "seconds",
      "real (wall-clock) time in seconds for all accuracy levels together. A level that is predicted to exceed it is not started; no "
      "limit if not given");
  section.key("levels", levels, deck::between(3, 12), "1",
              "largest number of accuracy levels, each of which is a run with a finer mesh and smaller tolerances than the level before. "
              "Level 0 has 3 elements per side; each further level has about 1.3 times as many, and tolerances a quarter as large. "
              "Increase it if the requested accuracy is not reached");
  if (section.documenting()) return;
  if (trimmed(texts).empty()) throw UserError(section.path("requests") + " is missing: for example `taylor_inertia=1e-3`.");
  requests = requests_of(texts);
  present = true;
}

std::string setting_of(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) requests_of(text);  // throws UserError if a text is not a request
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + trimmed(text);
  return "Accuracy/requests=" + deck::in_quotes(all);
}

std::span<const std::string_view> series_without_error() { return without_error; }

bool has_error(const std::string& series) {
  const std::string name = series.substr(series.rfind('/') + 1);
  return std::ranges::find(without_error, name) == without_error.end() && !name.starts_with("cell_") && !name.starts_with("gap_x") &&
         !name.starts_with("nearest_to_wall");
}

void check_series(const std::vector<Request>& requests, const std::vector<std::string>& names) {
  std::vector<std::string> allowed;
  std::ranges::copy_if(names, std::back_inserter(allowed), has_error);
  const bool branch = std::ranges::find(names, "fold") != names.end();
  for (const Request& request : requests) {
    if (branch && request.of == Of::mean)
      throw UserError("Accuracy/requests: " + request.text() + " is an average over time, which a branch of steady shapes does not have.");
    if (std::ranges::find(allowed, request.series) != allowed.end()) continue;
    if (std::ranges::find(names, request.series) != names.end())
      throw UserError("Accuracy/requests: the series " + request.series +
                      " describes the computation itself and has no error that could be requested.");
    const std::string meant = deck::guess(request.series, allowed);
    throw UserError("Accuracy/requests: the results of this scene hold no series " + request.series +
                    (meant.empty() ? "; inputs/SERIES.md lists the series." : "; was " + meant + " meant?"));
  }
}

}  // namespace tanktread::accuracy
