#include "output/file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

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

fs::path beside(const fs::path& path) { return path.string() + std::string(kUnfinished); }

void write_beside(const fs::path& path, std::string_view bytes) {
  Unfinished file(path, Unfinished::Begin::anew);
  file.write(0, bytes);
  file.close();
}

}  // namespace

Unfinished::Unfinished(const fs::path& path, Begin begin)
    : path_(path), file_(::open(beside(path).c_str(), begin == Begin::anew ? O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC : O_WRONLY | O_CLOEXEC, 0666)) {
  if (file_ < 0) fail(path_);
}

Unfinished::~Unfinished() {
  if (file_ >= 0) ::close(file_);
}

void Unfinished::write(std::uint64_t at, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail(path_);
    at += static_cast<std::uint64_t>(done);
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
}

void Unfinished::write(std::uint64_t at, std::span<const double> numbers) {
  write(at, std::string_view(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()));
}

void Unfinished::resize(std::uint64_t size) {
  if (::ftruncate(file_, static_cast<off_t>(size)) != 0) fail(path_);
}

void Unfinished::close() {
  if (::close(std::exchange(file_, -1)) != 0) fail(path_);
}

void finish(const fs::path& path) {
  if (std::rename(beside(path).c_str(), path.c_str()) != 0) fail(path);
}

void write_whole(const fs::path& path, std::string_view bytes) {
  write_beside(path, bytes);
  finish(path);
}

void rewrite_whole(const fs::path& path, std::string_view bytes) {
  write_beside(path, bytes);
  const fs::path part = beside(path);
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
