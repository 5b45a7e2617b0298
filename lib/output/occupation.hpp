#pragma once
// One run at a time in a directory.

#include <filesystem>

namespace tanktread::output {

/// Holds a directory, which is made where there is none, for this process alone. It is free again when this object or the process ends, however
/// it ends; nothing is left behind. File systems that know no locks, and directories that cannot be opened, hold nothing.
class Occupation {
 public:
  /// Throws UserError when another process holds the directory.
  explicit Occupation(const std::filesystem::path& directory);
  ~Occupation();
  Occupation(const Occupation&) = delete;
  Occupation& operator=(const Occupation&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace tanktread::output
