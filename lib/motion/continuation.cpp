#include "motion/continuation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "system/solvers/nonlinear.hpp"

namespace tanktread::motion {

namespace {
// a correction below this multiple of the tolerance counts as converged, because quadrature errors may prevent smaller corrections
constexpr double noise = 30;
}

void ContinuationOptions::declare(deck::Section& section) {
  section.key("parameter", parameter, deck::Choice{},
              "path of the numerical key of the deck that varies along the branch of steady shapes, for example Membrane/capillary number");
  section.key("to", to, deck::any(), "that of the key",
              "value, in the unit of the key that Continuation/parameter names, at which the branch of steady shapes ends. The branch starts "
              "at the value of that key in the deck, and also ends if it returns to this value after a fold");
  section.key("method", method, deck::Choice{"arclength", "natural"},
              "method of continuation along a branch of steady shapes. `arclength`: continues around folds, where the parameter turns "
              "back. `natural`: stops at the first fold");
  section.key(
      "step", step, deck::positive(), "that of the key",
      "first increment of the continuation parameter; if not given, a twentieth of the interval from the parameter's value in the deck to "
      "Continuation/to");
  section.key("largest change", largest_change, deck::between(1e-5, 1), "1",
              "largest allowed change of the shape between two points of the branch of steady shapes: root mean square displacement of the "
              "control points divided by R_C, the radius of the sphere with the particle's volume");
  section.key("points", points, deck::between(2, 100000), "1",
              "largest number of computed points on the branch of steady shapes, folds included");
  section.key("fold tolerance", fold_tolerance, deck::between(1e-12, 1e-2), "1",
              "largest allowed error of the continuation parameter at a fold, where the branch of steady shapes turns back, divided by the "
              "larger of the parameter there and a twentieth of the interval to Continuation/to");
  section.key("second parameter", second_parameter, deck::Choice{},
              "path of a second numerical key of the deck, for example Particle/viscosity ratio, to find how the fold depends on it. The "
              "branch is followed to its first fold with the value of this key in the deck. Then only the fold is computed, for each of "
              "Continuation/second values");
  section.key("second values", second_values, deck::any(), "that of the key",
              "values of the key Continuation/second parameter for which the fold is computed, in this order. Values that are evenly "
              "spaced, or have a constant ratio, need the least work");
  if (section.given("parameter") && !section.given("to"))
    throw UserError(section.path("to") + " is missing: give the value of " + parameter + " at which the branch of steady shapes ends.");
  if (second_parameter == parameter)
    throw UserError(section.path("second parameter") + " must differ from " + section.path("parameter") + ", but both are " + parameter + ".");
  if (second_parameter.has_value() != second_values.has_value())
    throw UserError(section.path("second parameter") + " and " + section.path("second values") + " belong together: give both or none.");
}

std::string ContinuationOptions::text(double value, double second) const {
  return formatted("%s %.8g", parameter.c_str(), value) + (second_parameter ? formatted(", %s %.8g", second_parameter->c_str(), second) : "");
}

std::string ContinuationOptions::remark(const BranchPoint& point) const {
  if (!point.fold || !(point.rest > fold_tolerance)) return {};
  return formatted("the error of the fold at %s is %.1g, above Continuation/fold tolerance: set smaller tolerances of Quadrature and Steady",
                   text(point.parameter, point.second).c_str(), point.rest);
}

void BranchPoint::add_columns(bool follows_fold, Columns& to) const {
  to.add(parameter, {"parameter", "of the key", "value of Continuation/parameter at this point of the branch of steady shapes"});
  to.add(fold, {"fold", "1", "1 at a fold, where the continuation parameter turns back along the branch, otherwise 0"});
  if (follows_fold) to.add(second, {"second_parameter", "of the key", "value of Continuation/second parameter at this fold"});
}

Branch::Branch(Family family, Remesh remesh, const ContinuationOptions& options, const SteadyOptions& steady,
               const coupling::SolverOptions& solvers, double parameter, double second, State x)
    : family_(std::move(family)), remesh_(std::move(remesh)), options_(options), steady_(steady), solvers_(solvers), start_(parameter),
      second_(second), first_(family_(parameter, second)), x_(std::move(x)) {}

double Branch::inner(const Place& a, const Place& b) const {
  const double unit = first_->unit_length();
  return dot(a.x, b.x) / (unit * unit) + a.q * b.q;
}

std::optional<Branch::Solved> Branch::at_parameter(double parameter, const State& x) {
  State found = x;
  SteadyReport report = find_steady(*family_(parameter, second_), steady_, solvers_, found);
  if (!report.converged && !(report.rest < noise * steady_.tolerance) && last_.empty() && search_) report = search_(found, report);
  why_ = report.why.empty() ? "" : ", because " + report.why;
  if (!report.converged && !(report.rest < noise * steady_.tolerance)) return {};
  return Solved{{std::move(found), parameter / unit_}, 0, report.iterations, report.rest};
}

/// Finds the intersection of the branch with the plane through the point `predicted` with the normal vector `normal`. `tolerance`: largest allowed
/// norm of the last correction.
std::optional<Branch::Solved> Branch::on_plane(const Place& predicted, const Place& normal, double tolerance) {
  constexpr int most_rounds = 8, most_iterations = 80;
  constexpr double far = 4;  // largest distance of the solution from the predicted point, divided by the step
  Solved solved{predicted, 0, 0, 0};
  for (int round = 0; round < most_rounds; ++round) {
    const Place from = solved.place;
    const std::shared_ptr<SteadyEquations> here = family_(from.q * unit_, second_);
    // towards the middle of the branch, so that the parameter stays in the range of its key
    const double aside = std::copysign(1e-3 * std::max(std::abs(from.q), std::abs(step_)), (start_ + options_.to) / (2 * unit_) - from.q);
    here->dynamics().freeze(from.x);
    const State slope = (family_((from.q + aside) * unit_, second_)->residual(from.x) - here->residual(from.x)) / aside;
    if (!slope.allFinite()) return {};
    const State b = here->precondition(from.x, slope);
    Place best;
    double least = std::numeric_limits<double>::infinity();
    // vectors of the iteration: a state, and the change of the scaled parameter
    const std::span<const coupling::Block> blocks = from.x.layout()->blocks();
    std::vector<coupling::Block> of_iteration(blocks.begin(), blocks.end());
    of_iteration.push_back({"parameter", -1, 1, 1, coupling::Parity::scalar});
    const auto layout = std::make_shared<coupling::Layout>(std::move(of_iteration));
    const Eigen::Index n = from.x.numbers().size();
    const auto joined = [&](const Place& place) {
      State both(layout);
      both.numbers() << place.x.numbers(), place.q;
      return both;
    };
    const auto place_of = [&](const State& both) {
      Place place{State(from.x.layout()), both.numbers()[n]};
      place.x.numbers() = both.numbers().head(n);
      return place;
    };
    const auto size = [&](const Place& place) { return std::hypot(here->dynamics().norm(place.x), place.q); };
    const auto corrected = [&](const State& both) -> State {
      const Place at = place_of(both);
      const State r = here->residual(at.x) + at.q * slope;
      if (!r.allFinite()) return coupling::not_a_number(both);
      const State a = here->precondition(at.x, r);
      const double more = -inner(normal, Place{at.x + a, from.q + at.q} - predicted) / inner(normal, {b, 1});
      const Place change{a + more * b, more};
      if (const double length = size(change); length < least) least = length, best = at;
      return joined({at.x + change.x, at.q + change.q});
    };
    State found = joined({from.x, 0});
    const coupling::FixedPoint solver(steady_.method, solvers_.nox, solvers_.of(solvers_.steady), coupling::FixedPoint::deep(n + 1));
    const int most = std::min(steady_.iterations, most_iterations);
    const auto norm = [&](const State& both) { return size(place_of(both)); };
    const coupling::NonlinearReport report = solver.solve(corrected, norm, tolerance, most, found);
    if (!report.converged && !(least < noise * tolerance)) return {};
    solved.iterations = std::max(solved.iterations, report.converged ? report.iterations : 0);
    solved.place = {best.x, from.q + best.q};
    if (length(solved.place - predicted) > far * std::max(step_, options_.largest_change)) return {};  // not on this branch
    const double moved = length(solved.place - from), turned = std::abs(solved.place.q - from.q);
    // estimated error, because dG/dp is evaluated at `from` and not at the solution: distance from `from`, times the change of the scaled parameter
    solved.rest = moved * turned;
    if (solved.rest < tolerance) return solved;
  }
  return {};
}

void Branch::keep(const Solved& solved) {
  last_.push_back(solved);
  if (last_.size() > 3) last_.erase(last_.begin());
  ahead_.emplace_back(solved, false);
  ended_ = ends(solved);
}

/// Returns whether the parameter has reached the end of the branch or returned to its start.
bool Branch::ends(const Solved& solved) const {
  constexpr double rounding = 1e-12;
  const double gone = (solved.place.q * unit_ - start_) / (options_.to - start_);
  return gone >= 1 - rounding || (last_.size() > 2 && gone < rounding);
}

/// If the point lies beyond an end of the branch, returns the value of the parameter at this end.
std::optional<double> Branch::end_before(const Place& place) const {
  const double gone = (place.q * unit_ - start_) / (options_.to - start_);
  if (gone > 1) return options_.to;
  if (gone < 0) return start_;
  return {};
}

/// Returns the prediction of the next point of the branch, one step further. It lies on the parabola in arclength through the last three points. If
/// there are fewer points, it lies on the straight line with the direction t.
Branch::Place Branch::predicted(const Place& t) const {
  const Solved& now = last_.back();
  if (last_.size() < 3) return now.place.along(t, step_);
  const Solved &one = last_[0], &two = last_[1];
  const double s = now.s + step_;
  const auto weight = [&](double a, double b, double c) { return (s - b) * (s - c) / ((a - b) * (a - c)); };
  const double first = weight(one.s, two.s, now.s), second = weight(two.s, one.s, now.s), third = weight(now.s, one.s, two.s);
  return {first * one.place.x + second * two.place.x + third * now.place.x, first * one.place.q + second * two.place.q + third * now.place.q};
}

/// Advances by one step along the branch. Halves the step until a point is found; returns nothing if the step becomes too small.
std::optional<Branch::Solved> Branch::stepped() {
  constexpr double least = 1e-6;
  const Solved& now = last_.back();
  const Place t = unit(now.place - last_[last_.size() - 2].place);
  const auto near = [&](const std::optional<Solved>& solved) { return solved && length(solved->place - now.place) < 2 * step_; };
  for (double first = step_; step_ > least * first; step_ *= 0.5) {
    Place next = predicted(t);
    std::optional<double> asked = end_before(next);
    if (options_.method == "natural" && !asked) {
      if ((next.q - now.place.q) * heading_ <= 0) continue;  // the prediction lies beyond a fold
      asked = next.q * unit_;
    }
    if (!asked) {
      auto solved = on_plane(next, t, steady_.tolerance);
      if (!near(solved)) continue;
      asked = end_before(solved->place);
      if (!asked) {
        prediction_error_ = length(solved->place - next) / step_;
        return solved;
      }
      next = solved->place;
    }
    const Place way = next - now.place;
    if (auto solved = at_parameter(*asked, now.place.along(way, (*asked / unit_ - now.place.q) / way.q).x); near(solved)) return solved;
  }
  return {};
}

/// Adapts the mesh until it no longer changes, and recomputes the two latest points on each new mesh.
void Branch::adapt() {
  constexpr int most = 6;
  for (int k = 0; k < most; ++k) {
    std::vector<State> states{last_[last_.size() - 2].place.x, last_.back().place.x};
    if (!remesh_(last_.back().place.q * unit_, states)) return;
    last_.erase(last_.begin(), last_.end() - 2);
    first_ = family_(last_.back().place.q * unit_, second_);
    for (std::size_t i = 0; i < 2; ++i) last_[i].place.x = std::move(states[i]);
    ahead_.front().first = last_[1];
    const Place t = unit(last_[1].place - last_[0].place);
    for (Solved& one : last_) {
      auto solved = on_plane(one.place, t, steady_.tolerance);
      if (!solved) solved = at_parameter(one.place.q * unit_, one.place.x);
      if (!solved) throw RunFailure("a steady shape of the branch was not found on the refined mesh");
      solved->s = one.s;
      one = std::move(*solved);
    }
    last_[1].s = last_[0].s + length(last_[1].place - last_[0].place);
    x_ = last_[1].place.x;
    ahead_.front().first = last_[1];
  }
}

/// Returns the next point of the branch. Computes one more point in advance, because this point may reveal a fold that comes before the next point.
std::optional<BranchPoint> Branch::next() {
  while (ahead_.size() < 2 && !ended_ && failure_.empty()) {
    if (count_ >= options_.points) break;
    try {
      if (ahead_.size() == 1 && last_.size() > 1) adapt();
      advance();
    } catch (const RunFailure& failure) {
      failure_ = failure.what();
    }
  }
  if (ahead_.empty()) {
    if (!failure_.empty()) throw RunFailure(failure_);
    if (!next_fold()) return {};
  }
  const auto [solved, fold] = std::move(ahead_.front());
  ahead_.erase(ahead_.begin());
  double parameter = solved.place.q * unit_;
  for (const double end : {start_, options_.to})
    if (std::abs(parameter - end) < 1e-14 * std::abs(end)) parameter = end;  // removes rounding errors
  return BranchPoint{parameter, second_, solved.place.x, fold, solved.iterations, solved.rest};
}

/// Finds the first or the second point of the branch, each at a prescribed value of the parameter.
void Branch::begin() {
  constexpr int most_halvings = 8;
  const double way = options_.to - start_;
  double step = last_.empty() ? 0 : std::min(options_.step.value_or(std::abs(way) / 20), std::abs(way)), parameter = start_;
  std::optional<Solved> solved;
  for (int halvings = 0; !solved; ++halvings, step /= 2) {  // halves the step, because there may be a fold before the end of the step
    parameter = start_ + std::copysign(step, way);
    solved = at_parameter(parameter, x_);
    if (!solved && (last_.empty() || halvings == most_halvings))
      throw RunFailure(formatted("no steady shape was found at %s = %.8g", options_.parameter.c_str(), parameter) + why_);
  }
  if (last_.empty()) {
    x_ = solved->place.x;
  } else {
    const double change = first_->dynamics().norm(solved->place.x - x_);
    // If the shape does not depend on the parameter, `change` is 0. The parameter is therefore scaled such that it changes by at least 0.01
    // largest_change over a twentieth of the interval.
    const double least = 0.01 * options_.largest_change * std::abs(parameter - start_) / (std::abs(way) / 20);
    unit_ = std::abs(parameter - start_) / std::max(change, least);
    last_.front().place.q = start_ / unit_, solved->place.q = parameter / unit_;
    ahead_.front().first.place.q = start_ / unit_;
    solved->s = step_ = length(solved->place - last_.front().place);
    heading_ = solved->place.q - last_.front().place.q;
  }
  keep(*solved);
}

void Branch::advance() {
  ++count_;
  if (last_.size() < 2) return begin();
  // The step grows if the last solve took few iterations, or if the last prediction was close to the solution, which shows that the branch is nearly
  // straight. The second condition is needed because a small tolerance requires many iterations in any case.
  const int iterations = last_.back().iterations;
  const double change = iterations < 25 || prediction_error_ < 0.05 ? 1.5 : iterations < 45 || prediction_error_ < 0.2 ? 1 : 0.7;
  step_ = std::min(step_ * change, options_.largest_change * std::numbers::sqrt2);
  auto solved = stepped();
  if (!solved)
    throw RunFailure(formatted("the branch was lost beyond %s = %.8g: no further steady shape was found%s", options_.parameter.c_str(),
                               last_.back().place.q * unit_,
                               options_.method == "natural" ? "; there may be a fold, which Continuation/method `natural` does not pass" : ""));
  solved->s = last_.back().s + length(solved->place - last_.back().place);
  const double before = std::exchange(heading_, solved->place.q - last_.back().place.q);
  const bool folded = before * heading_ < 0;
  if (folded) {
    ++count_;
    auto found = fold({last_[last_.size() - 2], last_.back(), *solved});
    if (!found)
      throw RunFailure("the fold of the branch was passed, but not located to Continuation/fold tolerance: set a larger tolerance");
    ahead_.emplace_back(found->at, true);
    folds_ = {std::move(*found)};
  }
  keep(*solved);
  std::ranges::stable_sort(ahead_, {}, [](const auto& one) { return one.first.s; });
  if (!folded || !options_.second_parameter) return;
  ended_ = true;
  while (!ahead_.back().second) ahead_.pop_back();
}

}  // namespace tanktread::motion
