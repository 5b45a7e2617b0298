#pragma once
// A file of named arrays that is written once, such as what a script needs to draw the scene.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tanktread::output {

/// Row-major; an empty shape is a number.
struct Array {
  std::string name, unit, description;
  std::vector<double> values;
  std::vector<std::size_t> shape;
};

/// HDF5: `/<name>`, doubles with attributes `unit` and `description`. In one step (write_whole). Throws RunFailure.
void write_arrays(const std::filesystem::path& path, const std::vector<Array>& arrays);

}  // namespace tanktread::output
