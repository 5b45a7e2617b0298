#include "record/files/state.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "system/agreement.hpp"

namespace tanktread::output {
namespace {

std::string numbered(const char* name, std::size_t k) { return name + std::to_string(k); }

/// Nets of a kind, by their numbers.
void store(const std::vector<Net>& nets, const char* name, Checkpoint& checkpoint) {
  for (std::size_t k = 0; k < nets.size(); ++k) checkpoint.arrays[numbered(name, k)] = nets[k];
}

std::vector<Net> stored(const char* name, const Checkpoint& checkpoint) {
  std::vector<Net> nets;
  for (std::size_t k = 0; checkpoint.arrays.contains(numbered(name, k)); ++k) nets.emplace_back(checkpoint.arrays.at(numbered(name, k)));
  return nets;
}

}  // namespace

void store(const motion::State& state, Checkpoint& checkpoint) {
  checkpoint.numbers["time"] = state.time;
  checkpoint.numbers["proposed_step"] = state.step;
  checkpoint.numbers["slope_error"] = state.slope_error;
  checkpoint.arrays["x"] = state.x;
  checkpoint.arrays["frozen"] = state.frozen;
  checkpoint.arrays["memory"] = Eigen::Map<const Eigen::VectorXd>(state.memory.data(), static_cast<Eigen::Index>(state.memory.size()));
  store(state.history, "slope_", checkpoint);
  store(state.secants.pairs(), "secant_", checkpoint);
  Eigen::VectorXd times(state.places.size());
  for (std::size_t k = 0; k < state.places.size(); ++k) {
    checkpoint.arrays[numbered("place_", k)] = state.places[k].x;
    times[static_cast<Eigen::Index>(k)] = state.places[k].time;
  }
  checkpoint.arrays["place times"] = times;
  checkpoint.arrays["direction"] = state.direction;
}

motion::State stored_state(const Checkpoint& checkpoint) {
  motion::State state;
  state.time = checkpoint.numbers.at("time");
  state.step = checkpoint.numbers.at("proposed_step");
  state.slope_error = checkpoint.numbers.at("slope_error");
  state.x = checkpoint.arrays.at("x");
  state.frozen = checkpoint.arrays.at("frozen");
  const Eigen::MatrixXd& memory = checkpoint.arrays.at("memory");
  state.memory.assign(memory.data(), memory.data() + memory.size());
  state.history = stored("slope_", checkpoint);
  const Eigen::MatrixXd& times = checkpoint.arrays.at("place times");
  for (Eigen::Index k = 0; k < times.size(); ++k)
    state.places.push_back({times(k), checkpoint.arrays.at(numbered("place_", static_cast<std::size_t>(k)))});
  state.direction = checkpoint.arrays.at("direction");
  state.secants = coupling::Secants(stored("secant_", checkpoint));
  return state;
}

bool equal_on_all_ranks(const motion::State& state) {
  Checkpoint checkpoint;
  store(state, checkpoint);
  const std::string mine = checksum(checkpoint);
  std::vector<double> digits(mine.begin(), mine.end());
  coupling::take_first(digits);
  return coupling::largest(!std::ranges::equal(mine, digits)) == 0;
}

}  // namespace tanktread::output
