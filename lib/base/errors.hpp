#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tanktread {

/// A mistake of the user's: one sentence that says what, where, what is allowed, what was given. Exit code 2.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Several of them, each with its sentence.
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

/// Throws UserError or UserErrors unless there are none.
inline void require_none(std::vector<std::string> mistakes) {
  if (mistakes.size() == 1) throw UserError(mistakes.front());
  if (!mistakes.empty()) throw UserErrors(std::move(mistakes));
}

/// Sentences about choices that cannot be made together, from the classes that know the reasons.
class Rejections {
 public:
  /// Adds a sentence if both choices are made.
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

/// Throws UserError if both choices are made.
inline void refuse(bool both, const std::string& one, const std::string& other, const std::string& why) {
  Rejections all;
  all.pair(both, one, other, why);
  all.throw_if_any();
}

/// A run that went wrong (not a number, folded element, step too small, solver not converged). Exit code 3, after a checkpoint.
struct RunFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace tanktread
