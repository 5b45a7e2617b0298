#pragma once
// Files that are whole at every moment: written beside their place, then renamed into it.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tanktread::output {

/// A file while it is written, beside its place, by any number of processes, each other bytes of it; `finish` puts it there.
/// All throw RunFailure (disk full, no permission).
class Unfinished {
 public:
  enum class Begin { anew, with_what_is_there };
  Unfinished(const std::filesystem::path& path, Begin begin);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  void write(std::uint64_t at, std::string_view bytes);
  void write(std::uint64_t at, std::span<const double> numbers);
  void resize(std::uint64_t size);  ///< what nobody writes is zero
  void close();                     ///< before finish

 private:
  std::filesystem::path path_;
  int file_;
};
void finish(const std::filesystem::path& path);

/// Puts `bytes` at `path` in one step: a reader, or a run that is killed here, finds the old file or the new one, never half of one.
/// Throws RunFailure (disk full, no permission).
void write_whole(const std::filesystem::path& path, std::string_view bytes);

/// The same for a file that is written many times a second. Old and new file change places, which no file system takes as a reason to go to the disk
/// at once, as some do for a file renamed over (0.2 ms and more); so it is the system's own time of writing, not this one, that a power failure
/// goes back to, maybe to no file.
void rewrite_whole(const std::filesystem::path& path, std::string_view bytes);

/// Makes `directory` ready for a run: creates it, and removes the results of an earlier run and unfinished files (only names that
/// a run writes). Throws UserError where it cannot.
void start_directory(const std::filesystem::path& directory);

/// The same for `--resume`: removes only unfinished files.
void tidy_directory(const std::filesystem::path& directory);

}  // namespace tanktread::output
