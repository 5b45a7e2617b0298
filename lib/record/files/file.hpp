#pragma once
// Files that are whole at every moment: written beside their place, then renamed into it; and the directory of a run.

#include <filesystem>
#include <string>
#include <string_view>

namespace tanktread::output {

/// Whether bytes are on the disk itself, which a failure of power leaves as it is, before anything says that they are.
enum class Durable { no, yes };

/// Puts `bytes` at `path` in one step: a reader, or a run that is killed here, finds the old file or the new one, never half of one.
/// Throws RunFailure (disk full, no permission).
void write_whole(const std::filesystem::path& path, std::string_view bytes, Durable durable = Durable::no);

/// Returns once a file, or the names of a directory, are on the disk. Throws RunFailure.
void sync(const std::filesystem::path& path);

/// Throw RunFailure with the system's reason where a file does not open (absent, no permission, too many open files, a pipe), or cannot be read to
/// its end. A file that passes and is not understood is damaged.
void check_opens(const std::filesystem::path& path);
void check_readable(const std::filesystem::path& path);

/// Gives a file another name, on which no run goes on: `<name>.damaged`, or `<name>.damaged.2` and so on. Returns it. Throws RunFailure.
std::filesystem::path set_aside(const std::filesystem::path& path);

/// Throws UserError where a directory holds results of a run.
void check_vacant(const std::filesystem::path& directory);

/// Makes `directory` ready for a run: creates it, and removes the results of an earlier run and unfinished files (only names that
/// a run writes). Throws UserError where it cannot.
void start_directory(const std::filesystem::path& directory);

/// The same for `--resume`: removes only unfinished files.
void tidy_directory(const std::filesystem::path& directory);

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
