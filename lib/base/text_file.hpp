#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace tanktread {

/// Returns the text of a file without its byte-order mark. `what` is the name of the file in messages (`The deck a.yaml`). Throws UserError if the
/// file is missing, unreadable, not a regular file (a directory, or a pipe, which might never end), or longer than `most` bytes.
std::string text_of_file(const std::filesystem::path& file, const std::string& what, std::size_t most);

/// Returns the text without blanks at its beginning and end.
std::string trimmed(const std::string& text);

}  // namespace tanktread
