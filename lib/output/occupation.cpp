#include "output/occupation.hpp"

#include <cerrno>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/errors.hpp"

namespace tanktread::output {

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

}  // namespace tanktread::output
