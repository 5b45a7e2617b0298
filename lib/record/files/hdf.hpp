#pragma once
// The few words of HDF5 that the results need. Included only by the .cpp files of this room.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <hdf5.h>

namespace tanktread::output::hdf {

/// Owns one HDF5 identifier. Throws std::runtime_error with `what` when HDF5 gave none.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t), const std::string& what);
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// A new file in memory, and its bytes as they would stand on disk: what is written to the disk goes there in one piece (write_whole), and a disk
/// that refuses is met with the system's reason and outside of HDF5, which does not recover from it. They are the file's own, not a copy, and stand
/// until it is written to again or closed.
Id new_file();
std::string_view image(const Id& file);

/// An existing file, for reading. Throws RunFailure when the system does not open it as a file, std::runtime_error when it is no HDF5 file.
Id open(const std::filesystem::path& path);

using Shape = std::vector<hsize_t>;  ///< empty: a scalar

/// Datasets of a file, row-major; groups on the way to `group/name` are made. `read_doubles` fills `shape` with what was found.
void write(hid_t file, const std::string& name, std::span<const double> values, const Shape& shape);
void write(hid_t file, const std::string& name, std::span<const std::int64_t> values);
void write(hid_t file, const std::string& name, std::span<const std::uint8_t> values);
void write(hid_t file, const std::string& name, const std::string& text);
void write_group(hid_t file, const std::string& name);  ///< an empty one
std::vector<double> read_doubles(hid_t file, const std::string& name, Shape& shape);
std::string read_text(hid_t file, const std::string& name);

/// What stands after `group/` in the names of the datasets below a group, in alphabetical order; none where there is no such group.
std::vector<std::string> datasets(hid_t file, const std::string& group);

/// Attributes of the object `name`.
void attribute(hid_t file, const std::string& name, const std::string& key, const std::string& text);
void attribute(hid_t file, const std::string& name, const std::string& key, std::span<const std::int64_t> values);
std::string read_attribute(hid_t file, const std::string& name, const std::string& key);
std::vector<std::string> attribute_names(hid_t file, const std::string& name);

}  // namespace tanktread::output::hdf
