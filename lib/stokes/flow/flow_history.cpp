#include "stokes/flow/flow_history.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/small_matrices.hpp"
#include "deck/section.hpp"
#include "deck/table.hpp"
#include "deck/words.hpp"

namespace tanktread::stokes {

namespace {

constexpr double degree = std::numbers::pi / 180;

/// Returns the solution F at s = 1 of dF/ds = (A + s B) F with F(0) = I, A = `first` and B = `change`. The interval is divided into parts so short
/// that the Taylor series of F converges fast on each.
Mat3 linear_deformation(const Mat3& first, const Mat3& change) {
  // Number of terms of the Taylor series in an interval of length h = 1/parts. As h (|first| + |change|) <= 1/2, the first neglected term is below
  // 1e-16.
  constexpr int terms = 20;
  const int parts = 1 + static_cast<int>(2 * (first.norm() + change.norm()));
  const double h = 1. / parts;
  Mat3 whole = Mat3::Identity();
  for (int part = 0; part < parts; ++part) {
    const Mat3 a = h * (first + part * h * change), b = h * h * change;
    Mat3 before = Mat3::Zero(), term = Mat3::Identity(), sum = term;
    for (int k = 1; k <= terms; ++k) {
      const Mat3 next = (a * term + b * before) / k;
      before = term, term = next;
      sum += term;
    }
    whole = sum * whole;
  }
  return whole;
}

}  // namespace

void FlowHistory::declare(deck::Section& section) {
  section.key(
      "type", type, deck::Choice{"table", "sine"},
      "time dependence of the ambient flow. `table`: the velocity is multiplied by the factors `amplitudes` and rotated by the `angles`, "
      "which are given at `times` and interpolated linearly. `sine`: the velocity is multiplied by mean + amplitude sin(2 pi frequency t "
      "+ phase)");
  section.key("times", times, deck::not_negative(), "time",
              "times at which `amplitudes` and `angles` of the ambient flow are given, in ascending order. Two equal times make a jump, "
              "for example a sudden stop of the flow. Before the first and after the last time the flow is constant");
  section.key("amplitudes", amplitudes, deck::any(), "1",
              "factors by which the velocity of the ambient flow is multiplied, one for each of `times`: 0 stops the flow, -1 reverses "
              "it; 1 if not given");
  section.key("angles", angles, deck::any(), "degree",
              "angles, in degrees, by which the ambient flow is rotated about `axis`, one for each of `times`; not rotated if not given");
  section.key("file", file,
              "path of a table with the time dependence of the ambient flow, instead of the keys `times`, `amplitudes` and `angles`. A row "
              "holds the time in the deck's unit, the factor of the velocity and, in all rows or in none, the angle in degrees. A first "
              "line may name the columns (time, amplitude, angle), in any order, and their units. A relative path is looked up in the "
              "working directory, "
              "then in the directory of the deck");
  if (angles || section.given("angles")) axis = "x2";
  section.key("axis", axis, deck::Choice{"x1", "x2", "x3"},
              "axis through the origin about which the ambient flow is rotated by `angles`, with the right-hand rule; `x2` if not given");
  if (type == "sine") mean = 0, amplitude = 1, phase = 0;
  section.key("mean", mean, deck::any(), "1",
              "mean value of the factor mean + amplitude sin(2 pi frequency t + phase) by which the velocity of the ambient flow is "
              "multiplied; 0 if not given");
  section.key("amplitude", amplitude, deck::any(), "1",
              "amplitude of the factor mean + amplitude sin(2 pi frequency t + phase) by which the velocity of the ambient flow is "
              "multiplied; 1 if not given");
  section.key("frequency", frequency, deck::positive(), "1/time",
              "frequency, in periods per unit of time (not radians), of the factor mean + amplitude sin(2 pi frequency t + phase) by "
              "which the velocity of the ambient flow is multiplied");
  section.key("phase", phase, deck::any(), "degree",
              "phase, in degrees, of the factor mean + amplitude sin(2 pi frequency t + phase) by which the velocity of the ambient flow "
              "is multiplied; 0 if not given");
}

void FlowHistory::read() {
  if (!file) return;
  for (const auto& [key, given] : {std::pair{"times", &times}, {"amplitudes", &amplitudes}, {"angles", &angles}})
    refuse(given->has_value(), "Flow/history/file", std::string("Flow/history/") + key, "the file holds all of them");
  const std::string name = "Flow/history/file " + deck::in_quotes(deck::shortened(file->path, 80));
  times.emplace(), amplitudes.emplace();
  for (const deck::TableRow& row : deck::read_table(*file, name, {{{"time", "time"}, {"amplitude", "1", true}, {"angle", "degree"}}, {2, 3}})) {
    times->push_back(row.numbers[0]);
    amplitudes->push_back(row.numbers[1]);
    if (row.numbers.size() == 3 && !angles) angles.emplace(), axis = axis.value_or("x2");
    if (angles) angles->push_back(row.numbers[2]);
    if (times->back() < 0 || (times->size() > 1 && times->back() < times->end()[-2]))
      throw UserError(name + formatted(", line %d: times must not be negative and must be in ascending order.", row.line));
  }
}

void FlowHistory::check() const {
  const std::string own = "Flow/history/type `" + type + "`";
  const auto belongs = [&](const char* key, bool given, const char* owner) {
    if (given && type != owner)
      throw UserError(std::string("Flow/history/") + key + " belongs to the type `" + owner + "`, but is given with " + own + ".");
  };
  belongs("file", file.has_value(), "table");
  belongs("times", times.has_value(), "table");
  belongs("amplitudes", amplitudes.has_value(), "table");
  belongs("angles", angles.has_value(), "table");
  belongs("axis", axis.has_value(), "table");
  belongs("mean", mean.has_value(), "sine");
  belongs("amplitude", amplitude.has_value(), "sine");
  belongs("frequency", frequency.has_value(), "sine");
  belongs("phase", phase.has_value(), "sine");
  if (type == "sine") {
    if (!frequency) throw UserError(own + " needs Flow/history/frequency.");
    return;
  }
  if (!times) throw UserError(own + " needs Flow/history/times or Flow/history/file.");
  if (!amplitudes && !angles) throw UserError(own + " needs Flow/history/amplitudes or Flow/history/angles.");
  if (axis && !angles) throw UserError("Flow/history/axis needs Flow/history/angles.");
  const auto as_many = [&](const char* key, const std::optional<std::vector<double>>& values) {
    if (values && values->size() != times->size())
      throw UserError(std::string("Flow/history/") + key + " must hold as many numbers as Flow/history/times, " + std::to_string(times->size()) +
                      ", but holds " + std::to_string(values->size()) + ".");
  };
  as_many("amplitudes", amplitudes);
  as_many("angles", angles);
  if (!std::ranges::is_sorted(*times)) throw UserError("Flow/history/times must be in ascending order.");
}

FlowHistory::Moment FlowHistory::at(double time, double start) const {
  if (type == "sine") return {*mean + *amplitude * std::sin(2 * std::numbers::pi * *frequency * time + *phase * degree)};
  // Selects the interval of the table in which the step began. `start` may differ from a time of the table by round-off.
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(*times, start * (1 + 1e-12)) - times->begin());
  const std::size_t j = std::min(after, times->size() - 1), i = after == 0 ? 0 : after - 1;
  const double t = i == j ? 0 : std::clamp((time - (*times)[i]) / ((*times)[j] - (*times)[i]), 0.0, 1.0);
  const auto value = [&](const std::vector<double>& values) { return (1 - t) * values[i] + t * values[j]; };
  Moment now;
  if (amplitudes) now.amplitude = value(*amplitudes);
  if (angles) now.angle = value(*angles), now.turn = turn(now.angle);
  return now;
}

/// If the flow does not rotate, the gradients at all times commute, and the deformation F is one matrix exponential. If it rotates, the rotation Q
/// has a constant angular velocity tensor W between two times of the table. Then Q^T F satisfies an equation with the gradient a L - W, where the
/// amplitude a is linear in time and L is the gradient at amplitude 1.
Mat3 FlowHistory::deformation(const Mat3& gradient, double time) const {
  if (type == "sine") {
    const double half = std::numbers::pi * *frequency * time;  // avoids the cancellation of two cosines in the integral of the sine
    return exponential((*mean * time + *amplitude / (std::numbers::pi * *frequency) * std::sin(half) * std::sin(half + *phase * degree)) * gradient);
  }
  std::vector<double> ends{0};
  std::ranges::copy_if(*times, std::back_inserter(ends), [&](double end) { return end > 0 && end < time; });
  ends.push_back(time);
  if (!angles) {
    double integral = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      integral += (ends[i + 1] - ends[i]) * (at(ends[i], ends[i]).amplitude + at(ends[i + 1], ends[i]).amplitude) / 2;
    return exponential(integral * gradient);
  }
  Mat3 whole = Mat3::Identity();
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double length = ends[i + 1] - ends[i];
    if (!(length > 0)) continue;
    const Moment first = at(ends[i], ends[i]), last = at(ends[i + 1], ends[i]);
    const int k = axis.value()[1] - '1', l = (k + 1) % 3, m = (k + 2) % 3;
    Mat3 turning = Mat3::Zero();
    turning(m, l) = (last.angle - first.angle) * degree;
    turning(l, m) = -turning(m, l);
    whole = last.turn * linear_deformation(length * first.amplitude * gradient - turning, length * (last.amplitude - first.amplitude) * gradient) *
            first.turn.transpose() * whole;
  }
  return whole;
}

Mat3 FlowHistory::turn(double angle) const { return Eigen::AngleAxisd(angle * degree, Vec3::Unit(axis.value()[1] - '1')).toRotationMatrix(); }

double FlowHistory::next_kink(double time) const {
  constexpr double never = std::numeric_limits<double>::infinity();
  if (type == "sine") return never;
  const auto next = std::ranges::upper_bound(*times, time);
  return next == times->end() ? never : *next;
}

}  // namespace tanktread::stokes
