#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tanktread {

/// Error in the user's input. The message is one sentence: what is wrong, where, what is allowed, what was given. Exit code 2.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Several errors in the user's input, one sentence each.
struct UserErrors : UserError {
  explicit UserErrors(std::vector<std::string> sentences) : UserError(joined(sentences)), all(std::move(sentences)) {}
  std::vector<std::string> all;

 private:
  static std::string joined(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence;
    return text;
  }
};

/// Throws UserError for one mistake and UserErrors for several. Does nothing if there are none.
inline void require_none(std::vector<std::string> mistakes) {
  if (mistakes.size() == 1) throw UserError(mistakes.front());
  if (!mistakes.empty()) throw UserErrors(std::move(mistakes));
}

/// Returns a sentence about two choices that contradict each other. `why`: reason, without a full stop.
inline std::string contradiction(const std::string& one, const std::string& other, const std::string& why) {
  return one + " and " + other + " contradict each other: " + why + ".";
}

/// Throws UserError if both of two contradictory choices are made.
inline void refuse(bool both, const std::string& one, const std::string& other, const std::string& why) {
  if (both) throw UserError(contradiction(one, other, why));
}

/// Failure of a run (NaN, folded element, step too small, solver not converged). The program writes a checkpoint and ends with exit code 3.
struct RunFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace tanktread
