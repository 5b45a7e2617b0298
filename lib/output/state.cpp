#include "output/state.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tanktread::output {
namespace {

std::string slope_name(std::size_t k) { return "slope_" + std::to_string(k); }

std::string secant_name(std::size_t k) { return "secant_" + std::to_string(k); }

}  // namespace

void store(const motion::State& state, Checkpoint& checkpoint) {
  checkpoint.numbers["time"] = state.time;
  checkpoint.numbers["proposed_step"] = state.step;
  checkpoint.arrays["x"] = state.x;
  checkpoint.arrays["frozen"] = state.frozen;
  checkpoint.arrays["memory"] = Eigen::Map<const Eigen::VectorXd>(state.memory.data(), static_cast<Eigen::Index>(state.memory.size()));
  for (std::size_t k = 0; k < state.history.size(); ++k) checkpoint.arrays[slope_name(k)] = state.history[k];
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
  std::vector<Net> pairs;
  for (std::size_t k = 0; checkpoint.arrays.contains(secant_name(k)); ++k) pairs.emplace_back(checkpoint.arrays.at(secant_name(k)));
  state.secants = coupling::Secants(std::move(pairs));
  return state;
}

}  // namespace tanktread::output
