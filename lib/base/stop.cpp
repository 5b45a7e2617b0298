#include "base/stop.hpp"

#include "base/threads.hpp"

namespace tanktread {

namespace {

std::function<bool()> request;

}  // namespace

StopRules& stop_rules() {
  static StopRules rules;
  return rules;
}

void set_stop_request(std::function<bool()> requested) {
  request = std::move(requested);
  stop_rules().answers = true;
}

bool stop_requested() { return stop_rules().answers && request && request(); }

void stop_here() {
  if (thread_number() == 0 && stop_rules().alone && stop_requested()) answer_stop();
}

void answer_stop() {
  stop_rules().answers = false;
  throw Stopped();
}

}  // namespace tanktread
