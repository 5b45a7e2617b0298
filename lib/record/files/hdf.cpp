#include "record/files/hdf.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "record/files/file.hpp"

namespace tanktread::output::hdf {
namespace {

void check(herr_t status, const std::string& what) {
  if (status < 0) throw std::runtime_error("HDF5: " + what);
}

/// Switches off HDF5's own error messages. Failures become exceptions here.
void silence() { H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); }

Id space_of(const Shape& shape) {
  const int rank = static_cast<int>(shape.size());
  return {rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, shape.data(), nullptr), H5Sclose, "no data space"};
}

/// Returns the HDF5 type for a text: strings of its length, padded with null characters. HDF5 does not allow the length zero, so an empty text is one
/// null character.
Id text_type(const std::string& text) {
  const bool ascii = std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 128; });
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  return {type, H5Tclose, "no text type"};
}

Id write_any(hid_t file, const std::string& name, hid_t type, const Shape& shape, const void* data) {
  const Id space = space_of(shape), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "no list of link properties");
  check(H5Pset_create_intermediate_group(links, 1), "cannot create groups");
  Id set(H5Dcreate2(file, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, "cannot create " + name);
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "cannot write " + name);
  return set;
}

void write_attribute(hid_t object, const std::string& key, hid_t type, const Shape& shape, const void* data) {
  const Id space = space_of(shape);
  const Id id(H5Acreate2(object, key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "cannot create " + key);
  check(H5Awrite(id, type, data), "cannot write " + key);
}

Id dataset(hid_t file, const std::string& name) { return {H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "no dataset " + name}; }

/// Returns a text of the HDF5 type `type`. Calls read(buffer), which lets HDF5 fill the buffer, and removes the null characters with which HDF5 pads
/// the text.
template <class Read>
std::string text_of(const Id& type, const std::string& name, const Read& read) {
  std::string text(H5Tget_size(type), '\0');
  check(read(text.data()), "cannot read " + name);
  text.erase(text.find_last_not_of('\0') + 1);
  return text;
}

}  // namespace

Id::Id(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
  if (id_ < 0) throw std::runtime_error("HDF5: " + what);
}

Id new_file() {
  silence();
  static int files = 0;  // number of files in memory so far: HDF5 distinguishes open files by name, so each needs a unique name
  if (files == 0) H5set_free_list_limits(-1, -1, -1, -1, -1, -1);  // no limits: the caches of closed files, half a megabyte each, are kept for reuse
  const std::string name = "memory " + std::to_string(++files);
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no access list");
  check(H5Pset_fapl_core(access, 1 << 18, false), "no file in memory");
  return {H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "no file in memory"};
}

std::string_view image(const Id& file) {
  check(H5Fflush(file, H5F_SCOPE_LOCAL), "cannot flush");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  void* handle = nullptr;  // receives the address of the pointer to the file's bytes
  if (size <= 0 || H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0) throw std::runtime_error("HDF5: no image");
  return {reinterpret_cast<const char*>(*static_cast<unsigned char**>(handle)), static_cast<std::size_t>(size)};
}

Id open(const std::filesystem::path& path) {
  silence();
  check_opens(path);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "cannot open " + path.string()};
}

Id open_copy(const std::filesystem::path& path) {
  silence();
  check_opens(path);
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no access list");
  check(H5Pset_fapl_core(access, 1 << 18, false), "no file in memory");
  return {H5Fopen(path.c_str(), H5F_ACC_RDWR, access), H5Fclose, "cannot open " + path.string()};
}

Id write(hid_t file, const std::string& name, std::span<const double> values, const Shape& shape) {
  if (std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies()) != values.size())
    throw std::logic_error("the number of values of " + name + " does not agree with its shape");
  return write_any(file, name, H5T_NATIVE_DOUBLE, shape, values.data());
}
Id write(hid_t file, const std::string& name, std::span<const std::int64_t> values) {
  return write_any(file, name, H5T_NATIVE_INT64, {values.size()}, values.data());
}
Id write(hid_t file, const std::string& name, std::span<const std::uint8_t> values) {
  return write_any(file, name, H5T_NATIVE_UINT8, {values.size()}, values.data());
}
Id write(hid_t file, const std::string& name, const std::string& text) { return write_any(file, name, text_type(text), {}, text.c_str()); }

Id write_group(hid_t file, const std::string& name) {
  return {H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "cannot create " + name};
}

std::vector<double> read_doubles(hid_t file, const std::string& name, Shape& shape) {
  const Id set = dataset(file, name), space(H5Dget_space(set), H5Sclose, "no data space of " + name);
  shape.assign(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)), 0);
  check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "no shape of " + name);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  check(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "cannot read " + name);
  return values;
}

std::string read_text(hid_t file, const std::string& name) {
  const Id set = dataset(file, name), type(H5Dget_type(set), H5Tclose, "no type of " + name);
  return text_of(type, name, [&](char* text) { return H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text); });
}

std::vector<std::string> datasets(hid_t file, const std::string& group) {
  if (H5Lexists(file, group.c_str(), H5P_DEFAULT) <= 0) return {};
  std::vector<std::string> result;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Ovisit_by_name(file, group.c_str(), H5_INDEX_NAME, H5_ITER_INC, visit, &result, H5P_DEFAULT), "cannot list " + group);
  return result;
}

void attribute(const Id& object, const std::string& key, const std::string& text) {
  write_attribute(object, key, text_type(text), {}, text.c_str());
}
void attribute(const Id& object, const std::string& key, std::span<const std::int64_t> values) {
  write_attribute(object, key, H5T_NATIVE_INT64, {values.size()}, values.data());
}

std::string read_attribute(hid_t file, const std::string& name, const std::string& key) {
  const Id id(H5Aopen_by_name(file, name.c_str(), key.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "no attribute " + key);
  const Id type(H5Aget_type(id), H5Tclose, "no type of " + key);
  return text_of(type, key, [&](char* text) { return H5Aread(id, type, text); });
}

std::vector<std::string> attribute_names(hid_t file, const std::string& name) {
  std::vector<std::string> result;
  const auto visit = [](hid_t, const char* key, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(key);
    return 0;
  };
  check(H5Aiterate_by_name(file, name.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &result, H5P_DEFAULT), "cannot list attributes");
  return result;
}

}  // namespace tanktread::output::hdf
