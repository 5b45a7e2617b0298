#pragma once
// Wrappers of the HDF5 functions that the results need. Included only by the .cpp files of this module.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/versions.hpp"  // before hdf5.h

#include <hdf5.h>

namespace tanktread::output::hdf {

/// Owner of one HDF5 identifier, which it closes by `close`. Throws std::runtime_error with the message `what` if the identifier is invalid.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t), const std::string& what);
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Creates an HDF5 file in memory.
Id new_file();
/// Returns the bytes of a file in memory, which write_whole() then writes to the disk in one piece. So write errors, from which HDF5 does not
/// recover, occur outside of HDF5 and are reported with the system's reason. The bytes are not copied and must not be used after the file is changed
/// or closed.
std::string_view image(const Id& file);

/// Opens an existing file for reading. Throws RunFailure if the system cannot open it as a file, std::runtime_error if it is not an HDF5 file.
Id open(const std::filesystem::path& path);

/// Opens an existing file as a copy in memory. The copy can be written to, and image() returns its bytes. Throws like `open`.
Id open_copy(const std::filesystem::path& path);

using Shape = std::vector<hsize_t>;  ///< shape of a dataset; empty for a scalar

/// Write or read datasets of a file, row-major. `write` returns the dataset. It creates the missing groups of a name `group/name`. It throws
/// std::logic_error if `values` has another size than `shape`. `read_doubles` sets `shape` to the shape of the dataset.
Id write(hid_t file, const std::string& name, std::span<const double> values, const Shape& shape);
Id write(hid_t file, const std::string& name, std::span<const std::int64_t> values);
Id write(hid_t file, const std::string& name, std::span<const std::uint8_t> values);
Id write(hid_t file, const std::string& name, const std::string& text);
Id write_group(hid_t file, const std::string& name);  ///< writes an empty group and returns it
std::vector<double> read_doubles(hid_t file, const std::string& name, Shape& shape);
std::string read_text(hid_t file, const std::string& name);

/// Returns the names of the datasets below a group, without `group/`, in alphabetical order; empty if there is no such group.
std::vector<std::string> datasets(hid_t file, const std::string& group);

/// Writes an attribute of a dataset or group.
void attribute(const Id& object, const std::string& key, const std::string& text);
void attribute(const Id& object, const std::string& key, std::span<const std::int64_t> values);

/// Returns the text of the attribute `key` of the dataset or group `name`.
std::string read_attribute(hid_t file, const std::string& name, const std::string& key);
/// Returns the names of all attributes of the dataset or group `name`.
std::vector<std::string> attribute_names(hid_t file, const std::string& name);

}  // namespace tanktread::output::hdf
