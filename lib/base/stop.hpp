#pragma once
// Requests to stop the program, and the points of long computations at which they are answered.

#include <functional>
#include <utility>

namespace tanktread {

/// Thrown where a stop request is answered. It does not derive from std::exception, so no scheme treats it as an error.
struct Stopped {};

/// Sets the function that returns true if this process is to stop, for example because of a signal or a time limit. Once the function has returned
/// true, it must continue to do so. A request is answered only once, so that the program can write its results. This function withdraws an answer.
void set_stop_request(std::function<bool()> requested);

/// Returns whether this process is to stop and has not answered the request.
bool stop_requested();

/// Throws Stopped if this process is to stop. Loops that take long and make no collective calls call it between their blocks. On one of several
/// ranks, does nothing except within the work of coupling::stop_together(), because the other ranks would wait for a rank that stops alone. In a
/// loop of several threads, only the thread that started the loop answers.
void stop_here();

/// Marks the request as answered and throws Stopped.
[[noreturn]] void answer_stop();

/// Sets a variable during the lifetime of this object.
class [[nodiscard]] Meanwhile {
 public:
  Meanwhile(bool& variable, bool value) : variable_(variable), before_(std::exchange(variable, value)) {}
  ~Meanwhile() { variable_ = before_; }
  Meanwhile(const Meanwhile&) = delete;
  Meanwhile& operator=(const Meanwhile&) = delete;

 private:
  bool& variable_;
  bool before_;
};

/// How this process answers stop requests.
struct StopRules {
  bool answers = true;  ///< false while results are written, so that they are complete, and after a request has been answered
  bool alone = true;    ///< true if stop_here() may throw: on a single rank, and within the work of coupling::stop_together()
};
StopRules& stop_rules();

}  // namespace tanktread
