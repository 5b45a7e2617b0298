#include "record/files/arrays.hpp"

#include "record/files/file.hpp"
#include "record/files/hdf.hpp"

namespace tanktread::output {

void write_arrays(const std::filesystem::path& path, const std::vector<Array>& arrays) {
  const hdf::Id file = hdf::new_file();
  for (const Array& array : arrays) {
    hdf::write(file, array.name, array.values, hdf::Shape(array.shape.begin(), array.shape.end()));
    hdf::attribute(file, array.name, "unit", array.unit);
    hdf::attribute(file, array.name, "description", array.description);
  }
  write_whole(path, hdf::image(file));
}

}  // namespace tanktread::output
