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

/// Collects sentences about choices that contradict each other. Each class adds the sentences whose reasons it knows.
class Rejections {
 public:
  /// Adds a sentence if both of two contradictory choices are made. `why`: reason, appended to the sentence.
  void pair(bool both, const std::string& one, const std::string& other, const std::string& why) {
    if (both) sentences_.push_back(one + " and " + other + " contradict each other: " + why + ".");
  }
  void add(bool wrong, const std::string& sentence) {
    if (wrong) sentences_.push_back(sentence);
  }
  void throw_if_any() const { require_none(sentences_); }

 private:
  std::vector<std::string> sentences_;
};

/// Throws UserError if both of two contradictory choices are made.
inline void refuse(bool both, const std::string& one, const std::string& other, const std::string& why) {
  Rejections all;
  all.pair(both, one, other, why);
  all.throw_if_any();
}

/// Failure of a run (NaN, folded element, step too small, solver not converged). The program writes a checkpoint and ends with exit code 3.
struct RunFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace tanktread
