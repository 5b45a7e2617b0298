#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "output/occupation.hpp"

namespace tanktread::output {
namespace {

TEST(Occupations, AreOneAtATimeAndLeaveNothingBehind) {
  const std::filesystem::path directory = std::filesystem::path(testing::TempDir()) / "occupied" / "results";
  std::filesystem::remove_all(directory.parent_path());
  auto one = std::make_unique<Occupation>(directory);
  EXPECT_TRUE(std::filesystem::is_empty(directory));
  EXPECT_THROW(Occupation other(directory), UserError);
  one.reset();
  EXPECT_NO_THROW(Occupation other(directory));
  EXPECT_TRUE(std::filesystem::is_empty(directory));
}

}  // namespace
}  // namespace tanktread::output
