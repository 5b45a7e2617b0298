#include "base/timing.hpp"

#include <algorithm>

namespace tanktread {

namespace {
const Phases::Clock::time_point before_main = Phases::Clock::now();
}

Phases started() {
  Phases phases;
  { const Phases::Scope start(phases, "start", before_main); }
  return phases;
}

double Phases::seconds(std::string_view name) const {
  const auto it = std::ranges::find(phases_, name, &Phase::name);
  return it == phases_.end() ? 0 : it->seconds;
}

double Phases::total() const {
  double sum = 0;
  for (const Phase& phase : phases_) sum += phase.seconds;
  return sum;
}

void Phases::charge() {
  const auto now = Clock::now();
  if (!open_.empty()) phases_[open_.back()].seconds += std::chrono::duration<double>(now - since_).count();
  since_ = now;
}

void Phases::enter(std::string_view name) {
  charge();
  auto it = std::ranges::find(phases_, name, &Phase::name);
  if (it == phases_.end()) it = phases_.insert(it, Phase{.name = std::string(name)});
  ++it->calls;
  open_.push_back(static_cast<std::size_t>(it - phases_.begin()));
}

void Phases::leave() {
  charge();
  open_.pop_back();
}

}  // namespace tanktread
