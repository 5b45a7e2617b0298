#include <filesystem>
#include <memory>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "record/files/file.hpp"
#include "scratch.hpp"

namespace tanktread::output {
namespace {

TEST(Occupations, AreExclusiveAndLeaveNoFiles) {
  const Scratch scratch;
  const std::filesystem::path directory = scratch / "results";
  auto one = std::make_unique<Occupation>(directory);
  EXPECT_TRUE(std::filesystem::is_empty(directory));
  EXPECT_THROW(Occupation other(directory), UserError);
  one.reset();
  EXPECT_NO_THROW(Occupation other(directory));
  EXPECT_TRUE(std::filesystem::is_empty(directory));
}

}  // namespace
}  // namespace tanktread::output
