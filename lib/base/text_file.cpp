#include "base/text_file.hpp"

#include <fstream>
#include <iterator>

#include "base/errors.hpp"

namespace tanktread {

std::string text_of_file(const std::filesystem::path& file, const std::string& what, std::size_t most) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) throw UserError(what + " does not exist.");
  if (fs::is_directory(status)) throw UserError(what + " is a directory, not a file.");
  if (error) throw UserError(what + " cannot be read: " + error.message() + ".");
  if (!fs::is_regular_file(status)) throw UserError(what + " is not a regular file, but a pipe or a device.");
  if (fs::file_size(file, error) > most) throw UserError(what + " is larger than " + std::to_string(most / 1'000'000) + " MB.");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw UserError(what + " cannot be read.");
  std::string text(std::istreambuf_iterator<char>(stream), {});
  const std::string byte_order_mark = "\xEF\xBB\xBF";  // some editors write this mark at the beginning of UTF-8 files
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

}  // namespace tanktread
