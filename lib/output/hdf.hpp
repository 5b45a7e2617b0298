#pragma once
// The few words of HDF5 that the results need. Included only by the .cpp files of this room.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
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
  ~Id();
  Id(Id&& other) noexcept;
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// A new file that lives in memory only, and its bytes as they would stand on disk: valid until the file changes or is closed.
Id new_file();
std::string_view image(const Id& file);

/// An existing file, for reading. Throws std::runtime_error when it is missing, damaged or no HDF5 file.
Id open(const std::filesystem::path& path);

Id new_group(hid_t parent, const std::string& name);
Id group(hid_t parent, const std::string& name);
std::vector<std::string> names(hid_t group);  ///< of the members, in alphabetical order

using Shape = std::vector<hsize_t>;  ///< empty: a scalar

/// A new file some of whose datasets others fill on disk. It lives in memory, where those take no room when they are made last.
class Draft {
 public:
  Draft();
  ~Draft();
  operator hid_t() const { return *file_; }

  /// A dataset that has no values yet. Returns where in the file its first one belongs.
  std::int64_t room(hid_t parent, const std::string& name, const Shape& shape, hid_t type = H5T_NATIVE_DOUBLE);

  /// Closes the file: its size, and bytes that it begins with. Behind them stands nothing but what is to be filled.
  struct Bytes {
    std::string_view first;
    std::uint64_t size;
  };
  Bytes close();

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
  std::optional<Id> file_;
};

/// Datasets, row-major. `read_*` fill `shape` with what was found.
void write(hid_t parent, const std::string& name, std::span<const double> values, const Shape& shape);
void write(hid_t parent, const std::string& name, std::span<const std::int64_t> values);
void write(hid_t parent, const std::string& name, std::span<const std::uint8_t> values);
void write(hid_t parent, const std::string& name, const std::string& text);

/// A one-dimensional dataset of doubles that holds `values` and can grow to `capacity` of them.
Id new_column(hid_t parent, const std::string& name, std::span<const double> values, std::size_t capacity);

/// Makes columns of `rows` values longer by one value each.
void append(std::span<const Id> columns, std::size_t rows, std::span<const double> values);

std::vector<double> read_doubles(hid_t parent, const std::string& name, Shape& shape);
std::string read_text(hid_t parent, const std::string& name);

/// Attributes of the object `name` under `parent` ("." for the parent itself).
void attribute(hid_t parent, const std::string& name, const std::string& key, const std::string& text);
void attribute(hid_t parent, const std::string& name, const std::string& key, std::span<const std::int64_t> values);
std::string read_attribute(hid_t parent, const std::string& name, const std::string& key);
std::vector<std::string> attribute_names(hid_t parent, const std::string& name);

}  // namespace tanktread::output::hdf
