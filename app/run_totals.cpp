#include "app/run_totals.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "base/formatted.hpp"

namespace tanktread {

namespace {

constexpr std::string_view phase_prefix = "wall seconds of ";

std::string warning_name(std::size_t k) { return formatted("warning %04zu", k); }

}  // namespace

void PhaseAngle::advance(double step, double now, std::optional<double> angle) {
  const double expected = degrees + (rate + now) / 2 * step * 180 / std::numbers::pi;
  degrees = angle ? *angle + 360 * std::round((expected - *angle) / 360) : expected;
  rate = now;
}

void store(const RunTotals& totals, output::Checkpoint& checkpoint) {
  each_count(totals, [&](const char* name, auto, auto, const auto& count) { checkpoint.numbers[name] = static_cast<double>(count); });
  checkpoint.numbers["steps at the limit of stability"] = totals.warnings.limited;
  checkpoint.numbers["wall seconds"] = totals.wall_seconds;
  checkpoint.numbers["growth of waves"] = totals.warnings.waves;
  Eigen::MatrixXd phase_angle(totals.phase_angle.size(), 2);
  for (std::size_t p = 0; p < totals.phase_angle.size(); ++p)
    phase_angle.row(static_cast<Eigen::Index>(p)) << totals.phase_angle[p].degrees, totals.phase_angle[p].rate;
  checkpoint.arrays["phase and tank-treading frequency"] = phase_angle;
  for (const auto& [phase, seconds] : totals.seconds) checkpoint.numbers[std::string(phase_prefix) + phase] = seconds;
  for (std::size_t k = 0; k < totals.warnings.said.size(); ++k)
    checkpoint.texts[warning_name(k)] = totals.warnings.said[k].kind + "\n" + totals.warnings.said[k].sentence;
}

RunTotals stored_totals(const output::Checkpoint& checkpoint) {
  RunTotals totals;
  each_count(totals, [&]<class Count>(const char* name, auto, auto, Count& count) { count = static_cast<Count>(checkpoint.numbers.at(name)); });
  totals.warnings.limited = static_cast<int>(checkpoint.numbers.at("steps at the limit of stability"));
  totals.wall_seconds = checkpoint.numbers.at("wall seconds");
  totals.warnings.waves = checkpoint.numbers.at("growth of waves");
  for (const auto& row : checkpoint.arrays.at("phase and tank-treading frequency").rowwise()) totals.phase_angle.push_back({row[0], row[1]});
  for (const auto& [name, seconds] : checkpoint.numbers)
    if (name.starts_with(phase_prefix)) totals.seconds.emplace_back(name.substr(phase_prefix.size()), seconds);
  for (std::size_t k = 0; checkpoint.texts.contains(warning_name(k)); ++k) {
    const std::string& text = checkpoint.texts.at(warning_name(k));
    const std::size_t end = text.find('\n');
    totals.warnings.said.push_back({text.substr(0, end), text.substr(end + 1)});
  }
  return totals;
}

}  // namespace tanktread
