#pragma once
// Files that are whole at every moment: written beside their place, then renamed into it.

#include <filesystem>
#include <string>
#include <string_view>

namespace tanktread::output {

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
