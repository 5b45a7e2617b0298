#include "app/signals.hpp"

#include <csignal>

#include "base/stop.hpp"
#include "record/files/summary.hpp"
#include "system/parallel/agreement.hpp"

namespace tanktread {

namespace {

volatile std::sig_atomic_t signalled = 0;

void remember(int signal) {
  signalled = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_signals() {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = remember;  // SA_RESTART is not set, so that the signal interrupts a blocking read
    sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  set_stop_request(stop_signal_received);
}

bool stop_signal_received() { return signalled != 0; }

std::string reason_of_stop() {
  return coupling::any_stop_requested(stop_signal_received()) ? output::run_status::by_signal : output::run_status::by_clock;
}

std::string spoken(std::string status) {
  std::erase(status, ':');
  return status;
}

}  // namespace tanktread
