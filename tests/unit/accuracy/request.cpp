#include <gtest/gtest.h>

#include "accuracy/request.hpp"
#include "base/errors.hpp"

namespace tanktread::accuracy {
namespace {

TEST(Request, HasASeriesAPartAndAValue) {
  const Request plain = request_of("taylor_inertia=1e-3");
  EXPECT_EQ(plain.series, "taylor_inertia");
  EXPECT_EQ(plain.of, Of::run);
  EXPECT_DOUBLE_EQ(plain.value, 1e-3);
  EXPECT_FALSE(plain.relative);
  const Request end = request_of(" left/velocity_x1 @end = 0.5 % ");
  EXPECT_EQ(end.series, "left/velocity_x1");
  EXPECT_EQ(end.of, Of::end);
  EXPECT_DOUBLE_EQ(end.value, 5e-3);
  EXPECT_TRUE(end.relative);
  EXPECT_EQ(request_of("energy@mean=2").of, Of::mean);
}

TEST(Request, IsReadBackFromItsText) {
  for (const char* text : {"a=0.25", "b/a@end=1%", "a@mean=3e-05"}) EXPECT_EQ(request_of(text).text(), text);
}

TEST(Request, IsRejectedIfItHasAnotherForm) {
  for (const char* text : {"", "a", "a=", "=1", "a=-1", "a=0", "a=1x", "a@start=1", "a=1%%", "a=nan", "a=inf"})
    EXPECT_THROW(request_of(text), UserError) << text;
}

TEST(Request, NamesARecordedSeriesThatHasAnError) {
  const std::vector<std::string> names{"time", "taylor_inertia", "wall_seconds", "left/energy"};
  EXPECT_NO_THROW(check_series({request_of("taylor_inertia=1"), request_of("left/energy=1")}, names));
  try {
    check_series({request_of("taylor_inertai=1")}, names);
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("taylor_inertia meant"), std::string::npos) << error.what();
  }
  EXPECT_THROW(check_series({request_of("wall_seconds=1")}, names), UserError);
}

TEST(Request, OfTheCommandLineIsASetting) {
  EXPECT_EQ(setting_of({"a=1", "b@end=2%"}), "Accuracy/requests=\"a=1, b@end=2%\"");
  EXPECT_THROW(setting_of({"a"}), UserError);
}

}  // namespace
}  // namespace tanktread::accuracy
