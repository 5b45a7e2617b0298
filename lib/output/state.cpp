#include "output/state.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "coupling/agreement.hpp"

namespace tanktread::output {
namespace {

std::string slope_name(std::size_t k) { return "slope_" + std::to_string(k); }

std::string place_name(std::size_t k) { return "place_" + std::to_string(k); }

std::string secant_name(std::size_t k) { return "secant_" + std::to_string(k); }

}  // namespace

void store(const motion::State& state, Checkpoint& checkpoint) {
  checkpoint.numbers["time"] = state.time;
  checkpoint.numbers["proposed_step"] = state.step;
  checkpoint.arrays["x"] = state.x;
  checkpoint.arrays["frozen"] = state.frozen;
  checkpoint.arrays["memory"] = Eigen::Map<const Eigen::VectorXd>(state.memory.data(), static_cast<Eigen::Index>(state.memory.size()));
  for (std::size_t k = 0; k < state.history.size(); ++k) checkpoint.arrays[slope_name(k)] = state.history[k];
  Eigen::VectorXd times(state.places.size());
  for (std::size_t k = 0; k < state.places.size(); ++k) {
    checkpoint.arrays[place_name(k)] = state.places[k].x;
    times[static_cast<Eigen::Index>(k)] = state.places[k].time;
  }
  checkpoint.arrays["place times"] = times;
  checkpoint.arrays["direction"] = state.direction;
  const std::vector<Net>& pairs = state.secants.pairs();
  for (std::size_t k = 0; k < pairs.size(); ++k) checkpoint.arrays[secant_name(k)] = pairs[k];
}

motion::State stored_state(const Checkpoint& checkpoint) {
  motion::State state;
  state.time = checkpoint.numbers.at("time");
  state.step = checkpoint.numbers.at("proposed_step");
  state.x = checkpoint.arrays.at("x");
  state.frozen = checkpoint.arrays.at("frozen");
  const Eigen::MatrixXd& memory = checkpoint.arrays.at("memory");
  state.memory.assign(memory.data(), memory.data() + memory.size());
  for (std::size_t k = 0; checkpoint.arrays.contains(slope_name(k)); ++k) state.history.emplace_back(checkpoint.arrays.at(slope_name(k)));
  const Eigen::MatrixXd& times = checkpoint.arrays.at("place times");
  for (Eigen::Index k = 0; k < times.size(); ++k)
    state.places.push_back({times(k), checkpoint.arrays.at(place_name(static_cast<std::size_t>(k)))});
  state.direction = checkpoint.arrays.at("direction");
  std::vector<Net> pairs;
  for (std::size_t k = 0; checkpoint.arrays.contains(secant_name(k)); ++k) pairs.emplace_back(checkpoint.arrays.at(secant_name(k)));
  state.secants = coupling::Secants(std::move(pairs));
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
