#include "record/files/file.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "record/files/hdf.hpp"
#include "scratch.hpp"

namespace tanktread::output {
namespace {

TEST(Arrays, AreReadWithShapeAndUnit) {
  const Scratch scratch;
  write_arrays(scratch / "duct.h5", {{"table", "length", "what it is", {1, 2, 3, 4, 5, 6}, {2, 3}}, {"number", "1", "", {-0.5}, {}}});
  const hdf::Id file = hdf::open(scratch / "duct.h5");
  hdf::Shape shape;
  EXPECT_EQ(hdf::read_doubles(file, "table", shape), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(shape, (hdf::Shape{2, 3}));
  EXPECT_EQ(hdf::read_attribute(file, "table", "unit"), "length");
  EXPECT_EQ(hdf::read_doubles(file, "number", shape), std::vector<double>{-0.5});
  EXPECT_TRUE(shape.empty());
}

TEST(Arrays, NeedAsManyValuesAsTheirShape) {
  const Scratch scratch;
  EXPECT_THROW(write_arrays(scratch / "duct.h5", {{"table", "1", "", {1, 2, 3}, {2, 3}}}), std::logic_error);
  EXPECT_THROW(write_arrays(scratch / "duct.h5", {{"number", "1", "", {}, {}}}), std::logic_error);
}

}  // namespace
}  // namespace tanktread::output
