#include "output/file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include <fcntl.h>

#include "base/errors.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUnfinished = ".part";

bool is_result(const std::string& name) {
  return name == "run.h5" || name == "duct.h5" || name == "run.hdf.series" || name == "summary.yaml" ||
         (name.starts_with("snapshot_") && name.ends_with(".hdf"));
}

bool is_unfinished(const std::string& name) {
  return name.ends_with(kUnfinished) && is_result(name.substr(0, name.size() - kUnfinished.size()));
}

template <class Test>
void remove_where(const fs::path& directory, const Test& test) {
  std::vector<fs::path> doomed;
  for (const auto& entry : fs::directory_iterator(directory))
    if (entry.is_regular_file() && test(entry.path().filename().string())) doomed.push_back(entry.path());
  for (const auto& path : doomed) fs::remove(path);
}

[[noreturn]] void fail(const fs::path& path) { throw RunFailure("cannot write " + path.string() + ": " + std::strerror(errno)); }

/// The unfinished file beside `path`, with all bytes.
fs::path written_beside(const fs::path& path, std::string_view bytes) {
  fs::path part = path.string() + std::string(kUnfinished);
  std::FILE* file = std::fopen(part.c_str(), "wb");
  if (!file) fail(path);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (std::fclose(file) != 0 || !written) fail(path);
  return part;
}

}  // namespace

void write_whole(const fs::path& path, std::string_view bytes) {
  const fs::path part = written_beside(path, bytes);
  if (std::rename(part.c_str(), path.c_str()) != 0) fail(path);
}

void rewrite_whole(const fs::path& path, std::string_view bytes) {
  const fs::path part = written_beside(path, bytes);
  const bool exchanged = renameat2(AT_FDCWD, part.c_str(), AT_FDCWD, path.c_str(), RENAME_EXCHANGE) == 0;
  if ((exchanged ? std::remove(part.c_str()) : std::rename(part.c_str(), path.c_str())) != 0) fail(path);
}

void start_directory(const fs::path& directory) {
  try {
    fs::create_directories(directory);
    remove_where(directory, [](const std::string& name) { return is_result(name) || is_unfinished(name); });
  } catch (const fs::filesystem_error& error) {
    throw UserError("the output directory " + directory.string() + " cannot be used: " + error.code().message());
  }
}

void tidy_directory(const fs::path& directory) {
  try {
    remove_where(directory, is_unfinished);
  } catch (const fs::filesystem_error& error) {
    throw UserError("the output directory " + directory.string() + " cannot be used: " + error.code().message());
  }
}

}  // namespace tanktread::output
