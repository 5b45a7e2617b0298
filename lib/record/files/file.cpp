#include "record/files/file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <iterator>
#include <unistd.h>
#include <vector>

#include <sys/file.h>

#include "base/errors.hpp"
#include "record/files/hdf.hpp"
#include "record/files/run_record.hpp"

namespace tanktread::output {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view unfinished = ".part", damaged = ".damaged";

}  // namespace

bool is_result(const std::string& name) {
  return std::ranges::find(run_files, name, &RunFile::name) != std::end(run_files) ||
         (name.starts_with(snapshot_start) &&
          (name.ends_with(snapshot_end) || name.find(std::string(snapshot_end).append(damaged)) != name.npos));
}

namespace {

/// Returns true if the result shows that a run has recorded something.
bool is_of_run(const std::string& name) {
  return is_result(name) && std::ranges::none_of(run_files, [&](const RunFile& one) { return one.before_rows && one.name == name; });
}

bool is_unfinished(const std::string& name) {
  return name.ends_with(unfinished) && is_result(name.substr(0, name.size() - unfinished.size()));
}

/// Returns true if the entry of a directory is a folder `level_<k>` (level_folder()), which holds one run of an accuracy ladder (lib/accuracy).
bool is_level(const fs::directory_entry& entry) {
  constexpr std::string_view level = level_start;
  const std::string name = entry.path().filename();
  return entry.is_directory() && name.size() > level.size() && name.starts_with(level) && name[level.size()] >= '0' && name[level.size()] <= '9';
}

template <class Test>
std::vector<fs::path> files_where(const fs::path& directory, const Test& test) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(directory))
    if (std::error_code unknown; !entry.is_directory(unknown) && test(entry.path().filename().string())) found.push_back(entry.path());
  return found;
}

/// Calls act() and converts errors of the file system to a UserError that names the directory.
template <class Act>
void in_directory(const fs::path& directory, const Act& act) try {
  act();
} catch (const fs::filesystem_error& error) {
  throw UserError("the output directory " + directory.string() + " cannot be used: " + error.code().message());
}

[[noreturn]] void fail(const char* what, const fs::path& path) {
  throw RunFailure(std::string("cannot ") + what + " " + path.string() + ": " + std::strerror(errno));
}

/// Flushes a file to the disk. Returns false if that fails. Errors of file systems without fsync, in particular for directories, are ignored.
bool synced(int file) { return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == EROFS; }

/// Opens an existing file or directory for reading, without blocking on a pipe. Throws RunFailure if that fails. `number`: file descriptor.
struct Opened {
  explicit Opened(const fs::path& path) : number(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    if (number < 0) fail("read", path);
  }
  ~Opened() { ::close(number); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  int number;
};

}  // namespace

void write_whole(const fs::path& path, std::string_view bytes, Durable durable) {
  const fs::path beside = path.string() + std::string(unfinished);
  std::FILE* const file = std::fopen(beside.c_str(), "wbe");
  if (!file) fail("write", path);
  bool done = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
  done = done && (durable == Durable::no || synced(fileno(file)));
  if (std::fclose(file) != 0 || !done || std::rename(beside.c_str(), path.c_str()) != 0) fail("write", path);
}

void sync(const fs::path& path) {
  if (!synced(Opened(path).number)) fail("write", path);
}

void sync_results(const fs::path& directory, const std::set<std::string>& copies) try {
  for (const auto& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename();
    if (std::error_code unknown; (is_result(name) || copies.contains(name)) && entry.is_regular_file(unknown)) sync(entry.path());
  }
  sync(directory);
} catch (const fs::filesystem_error& error) {
  throw RunFailure("cannot read " + directory.string() + ": " + error.code().message());
}

void check_opens(const fs::path& path) {
  const Opened file(path);
  if (!fs::is_regular_file(path)) throw RunFailure("cannot read " + path.string() + ": it is not a regular file");
}

void check_readable(const fs::path& path) {
  check_opens(path);
  const Opened file(path);
  std::array<char, 1 << 16> bytes;
  for (ssize_t n = 1; n != 0;)
    if (n = ::read(file.number, bytes.data(), bytes.size()); n < 0 && errno != EINTR) fail("read", path);
}

fs::path set_aside(const fs::path& path) {
  fs::path aside = path.string() + std::string(damaged);
  for (int k = 2; fs::exists(aside); ++k) aside = path.string() + std::string(damaged) + "." + std::to_string(k);
  if (std::rename(path.c_str(), aside.c_str()) != 0) fail("rename", path);
  return aside;
}

void check_vacant(const fs::path& directory) {
  std::error_code absent;
  if (!fs::is_directory(directory, absent)) return;
  in_directory(directory, [&] {
    const bool ladder = fs::exists(directory / ladder_file);
    if (!ladder && files_where(directory, is_of_run).empty()) return;
    std::string name = directory.string(), why;
    try {
      if (!ladder) why = obstacle_to_resuming(directory);
    } catch (const RunFailure& failure) {
      why = failure.what();
    }
    throw UserError(name + " holds the results of a run" +
                    (why.empty() ? ": --resume " + name + " continues it," : " that --resume cannot continue (" + why + "):") +
                    " --overwrite deletes it first, --output chooses another directory.");
  });
}

void start_results(const fs::path& directory) {
  in_directory(directory, [&] {
    fs::create_directories(directory);
    for (const auto& old : files_where(directory, [](const std::string& name) { return is_result(name) || is_unfinished(name); }))
      fs::remove(old);
  });
}

void start_directory(const fs::path& directory) {
  start_results(directory);
  in_directory(directory, [&] {
    if (!fs::exists(directory / ladder_file)) return;  // folders `level_<k>` are not those of a ladder
    for (const auto& entry : fs::directory_iterator(directory))
      if (is_level(entry)) start_results(entry.path()), fs::remove(entry.path() / failure_file);
    fs::remove(directory / ladder_file);
  });
}

void tidy_directory(const fs::path& directory) {
  in_directory(directory, [&] {
    for (const auto& old : files_where(directory, is_unfinished)) fs::remove(old);
  });
}

Occupation::Occupation(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  descriptor_ = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw UserError("another run is writing to the directory " + directory.string());
}

Occupation::~Occupation() {
  if (descriptor_ >= 0) close(descriptor_);
}

void write_arrays(const std::filesystem::path& path, const std::vector<Array>& arrays) {
  const hdf::Id file = hdf::new_file();
  for (const Array& array : arrays) {
    const hdf::Id set = hdf::write(file, array.name, array.values, hdf::Shape(array.shape.begin(), array.shape.end()));
    hdf::attribute(set, "unit", array.unit);
    hdf::attribute(set, "description", array.description);
  }
  write_whole(path, hdf::image(file));
}

}  // namespace tanktread::output
