#include "app/standing.hpp"

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

void Turning::advance(double step, double now, std::optional<double> angle) {
  const double expected = degrees + (rate + now) / 2 * step * 180 / std::numbers::pi;
  degrees = angle ? *angle + 360 * std::round((expected - *angle) / 360) : expected;
  rate = now;
}

void store(const Standing& standing, output::Checkpoint& checkpoint) {
  each_count(standing, [&](const char* name, auto, auto, const auto& count) { checkpoint.numbers[name] = static_cast<double>(count); });
  checkpoint.numbers["steps at the limit of stability"] = standing.warnings.limited;
  checkpoint.numbers["wall seconds"] = standing.wall_seconds;
  checkpoint.numbers["growth of waves"] = standing.warnings.waves;
  Eigen::MatrixXd turning(standing.turning.size(), 2);
  for (std::size_t p = 0; p < standing.turning.size(); ++p)
    turning.row(static_cast<Eigen::Index>(p)) << standing.turning[p].degrees, standing.turning[p].rate;
  checkpoint.arrays["phase and tank-treading frequency"] = turning;
  for (const auto& [phase, seconds] : standing.seconds) checkpoint.numbers[std::string(phase_prefix) + phase] = seconds;
  for (std::size_t k = 0; k < standing.warnings.said.size(); ++k)
    checkpoint.texts[warning_name(k)] = standing.warnings.said[k].kind + "\n" + standing.warnings.said[k].sentence;
}

Standing stored_standing(const output::Checkpoint& checkpoint) {
  Standing standing;
  each_count(standing, [&]<class Count>(const char* name, auto, auto, Count& count) { count = static_cast<Count>(checkpoint.numbers.at(name)); });
  standing.warnings.limited = static_cast<int>(checkpoint.numbers.at("steps at the limit of stability"));
  standing.wall_seconds = checkpoint.numbers.at("wall seconds");
  standing.warnings.waves = checkpoint.numbers.at("growth of waves");
  for (const auto& row : checkpoint.arrays.at("phase and tank-treading frequency").rowwise()) standing.turning.push_back({row[0], row[1]});
  for (const auto& [name, seconds] : checkpoint.numbers)
    if (name.starts_with(phase_prefix)) standing.seconds.emplace_back(name.substr(phase_prefix.size()), seconds);
  for (std::size_t k = 0; checkpoint.texts.contains(warning_name(k)); ++k) {
    const std::string& text = checkpoint.texts.at(warning_name(k));
    const std::size_t end = text.find('\n');
    standing.warnings.said.push_back({text.substr(0, end), text.substr(end + 1)});
  }
  return standing;
}

}  // namespace tanktread
