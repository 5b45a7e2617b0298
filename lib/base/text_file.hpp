#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace tanktread {

/// The text of a file, which `what` names in messages (`The deck a.yaml`). Throws UserError where it is missing, unreadable, no regular file (a
/// directory, a pipe, which might never end), or longer than `most` bytes.
std::string text_of_file(const std::filesystem::path& file, const std::string& what, std::size_t most);

}  // namespace tanktread
