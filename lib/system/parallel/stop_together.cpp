#include "system/parallel/stop_together.hpp"

#include "system/parallel/agreement.hpp"

namespace tanktread::coupling {

void stop_together(const std::function<void()>& work) {
  bool stopped = false;
  try {
    const Meanwhile alone(stop_rules().alone, true);
    if (work) work();
  } catch (const Stopped&) {
    stopped = true;
  }
  if (any_stop_requested(stopped || stop_requested())) answer_stop();
}

}  // namespace tanktread::coupling
