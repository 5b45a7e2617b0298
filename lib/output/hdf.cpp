#include "output/hdf.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "output/file.hpp"

namespace tanktread::output::hdf {
namespace {

void check(herr_t status, const std::string& what) {
  if (status < 0) throw std::runtime_error("HDF5: " + what);
}

/// HDF5 would print its own stack of every failure; ours become exceptions.
void silence() { H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); }

Id space_of(const Shape& shape) {
  const int rank = static_cast<int>(shape.size());
  return {rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, shape.data(), nullptr), H5Sclose, "no data space"};
}

/// Fixed-length, null-padded: a length of zero does not exist in HDF5, so an empty text is one null character.
Id text_type(const std::string& text) {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose, "no text type");
  check(H5Tset_size(type, std::max<std::size_t>(text.size(), 1)), "no text type");
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), "no text type");
  const bool ascii = std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 128; });
  check(H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8), "no text type");
  return type;
}

/// Links that make the groups on their way.
Id with_groups() {
  Id links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "no list of link properties");
  check(H5Pset_create_intermediate_group(links, 1), "cannot create groups");
  return links;
}

void write_any(hid_t parent, const std::string& name, hid_t type, const Shape& shape, const void* data) {
  const Id space = space_of(shape);
  const Id set(H5Dcreate2(parent, name.c_str(), type, space, with_groups(), H5P_DEFAULT, H5P_DEFAULT), H5Dclose, "cannot create " + name);
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), "cannot write " + name);
}

Id dataset(hid_t parent, const std::string& name) { return {H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, "no dataset " + name}; }

/// HDF5 tells open files apart by their names, in memory too.
std::string memory_name() {
  static int files = 0;
  return "memory " + std::to_string(++files);
}

void trim(std::string& text) { text.erase(text.find_last_not_of('\0') + 1); }

}  // namespace

Id::Id(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
  if (id_ < 0) throw std::runtime_error("HDF5: " + what);
}
Id::~Id() {
  if (id_ >= 0) close_(id_);
}
Id::Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Id new_file() {
  silence();
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "no access list"), layout(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "no creation list");
  check(H5Pset_fapl_core(access, 1 << 18, false), "no file in memory");
  check(H5Pset_istore_k(layout, 1), "no short index");  // a column is one chunk
  return {H5Fcreate(memory_name().c_str(), H5F_ACC_TRUNC, layout, access), H5Fclose, "no file in memory"};
}

std::string image(const Id& file) {
  check(H5Fflush(file, H5F_SCOPE_LOCAL), "cannot flush");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  std::string bytes(static_cast<std::size_t>(std::max<ssize_t>(size, 0)), '\0');
  if (size <= 0 || H5Fget_file_image(file, bytes.data(), bytes.size()) < 0) throw std::runtime_error("HDF5: no image");
  return bytes;
}

Id open(const std::filesystem::path& path) {
  silence();
  check_opens(path);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "cannot open " + path.string()};
}

Id new_group(hid_t parent, const std::string& name) {
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "cannot create " + name};
}

Id group(hid_t parent, const std::string& name) { return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "no group " + name}; }

std::vector<std::string> names(hid_t group) {
  std::vector<std::string> result;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &result), "cannot list a group");
  return result;
}

std::vector<std::string> datasets(hid_t group) {
  std::vector<std::string> result;
  const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* list) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Ovisit(group, H5_INDEX_NAME, H5_ITER_INC, visit, &result), "cannot list a group");
  return result;
}

void write(hid_t parent, const std::string& name, std::span<const double> values, const Shape& shape) {
  write_any(parent, name, H5T_NATIVE_DOUBLE, shape, values.data());
}
void write(hid_t parent, const std::string& name, std::span<const std::int64_t> values) {
  write_any(parent, name, H5T_NATIVE_INT64, {values.size()}, values.data());
}
void write(hid_t parent, const std::string& name, std::span<const std::uint8_t> values) {
  write_any(parent, name, H5T_NATIVE_UINT8, {values.size()}, values.data());
}
void write(hid_t parent, const std::string& name, const std::string& text) { write_any(parent, name, text_type(text), {}, text.c_str()); }

Id new_column(hid_t parent, const std::string& name, std::size_t capacity) {
  const hsize_t none = 0, most = capacity;
  const Id space(H5Screate_simple(1, &none, &most), H5Sclose, "no data space"), how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "no creation list");
  check(H5Pset_chunk(how, 1, &most), "no chunk");
  return {H5Dcreate2(parent, name.c_str(), H5T_NATIVE_DOUBLE, space, with_groups(), how, H5P_DEFAULT), H5Dclose, "cannot create " + name};
}

void grow(const Id& column, std::span<const double> values, std::size_t known) {
  const hsize_t first = known, size = values.size(), fresh = size - first;
  const Id from(H5Screate_simple(1, &fresh, nullptr), H5Sclose, "no data space"), to(H5Screate_simple(1, &size, nullptr), H5Sclose, "no data space");
  check(H5Sselect_hyperslab(to, H5S_SELECT_SET, &first, nullptr, &fresh, nullptr), "no last places");
  check(H5Dset_extent(column, &size), "cannot extend a column");
  check(H5Dwrite(column, H5T_NATIVE_DOUBLE, from, to, H5P_DEFAULT, values.data() + known), "cannot write to a column");
}

std::vector<double> read_doubles(hid_t parent, const std::string& name, Shape& shape) {
  const Id set = dataset(parent, name);
  const Id space(H5Dget_space(set), H5Sclose, "no data space of " + name);
  const int rank = H5Sget_simple_extent_ndims(space);
  shape.assign(static_cast<std::size_t>(std::max(rank, 0)), 0);
  check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "no shape of " + name);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  check(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "cannot read " + name);
  return values;
}

std::string read_text(hid_t parent, const std::string& name) {
  const Id set = dataset(parent, name);
  const Id type(H5Dget_type(set), H5Tclose, "no type of " + name);
  std::string text(H5Tget_size(type), '\0');
  check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "cannot read " + name);
  trim(text);
  return text;
}

void attribute(hid_t parent, const std::string& name, const std::string& key, const std::string& text) {
  const Id type = text_type(text);
  const Id space = space_of({});
  const Id id(H5Acreate_by_name(parent, name.c_str(), key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
              "cannot create " + key);
  check(H5Awrite(id, type, text.c_str()), "cannot write " + key);
}

void attribute(hid_t parent, const std::string& name, const std::string& key, std::span<const std::int64_t> values) {
  const Id space = space_of({values.size()});
  const Id id(H5Acreate_by_name(parent, name.c_str(), key.c_str(), H5T_NATIVE_INT64, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
              H5Aclose, "cannot create " + key);
  check(H5Awrite(id, H5T_NATIVE_INT64, values.data()), "cannot write " + key);
}

std::string read_attribute(hid_t parent, const std::string& name, const std::string& key) {
  const Id id(H5Aopen_by_name(parent, name.c_str(), key.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "no attribute " + key);
  const Id type(H5Aget_type(id), H5Tclose, "no type of " + key);
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(id, type, text.data()), "cannot read " + key);
  trim(text);
  return text;
}

std::vector<std::string> attribute_names(hid_t parent, const std::string& name) {
  std::vector<std::string> result;
  const auto visit = [](hid_t, const char* key, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(key);
    return 0;
  };
  check(H5Aiterate_by_name(parent, name.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &result, H5P_DEFAULT),
        "cannot list attributes");
  return result;
}

}  // namespace tanktread::output::hdf
