#include "vibe_vision/calibrate/stop_list.hpp"

#include <gtest/gtest.h>

#include "vibe_core/program/error.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::stop_list_test {
namespace {

std::string errorOf(const std::string& text) {
  return vibe::errorOf([&] { parseStopList(text, "folder/stops.csv"); });
}

TEST(StopList, ImagesAndSlidesAreRead) {
  const std::vector<StopImage> stops =
      parseStopList("# by hand\nimage,slide\r\na.png,5 mm\n\n /data/b, c.png , -0.002\n", "folder/stops.csv");
  ASSERT_EQ(stops.size(), 2U);
  EXPECT_EQ(stops[0].image, "folder/a.png");
  EXPECT_DOUBLE_EQ(stops[0].slide, 5e-3);
  EXPECT_EQ(stops[0].line, 3);
  EXPECT_EQ(stops[1].image, "/data/b, c.png");
  EXPECT_DOUBLE_EQ(stops[1].slide, -2e-3);
}

TEST(StopList, MistakesAreNamed) {
  EXPECT_NE(errorOf("a.png,5 mm\n").find("stops.csv:1: slide: the list does not begin with the line 'image,slide'"),
            std::string::npos);
  EXPECT_NE(errorOf("image,slide\na.png\n").find("stops.csv:2: slide: is not an image and a slide"), std::string::npos);
  EXPECT_NE(errorOf("image,slide\na.png,5 deg\n").find("'5 deg' is an angle, but it must be a length"),
            std::string::npos);
  EXPECT_NE(errorOf("image,slide\na.png,5\n").find("is out of range"), std::string::npos);  // millimetres meant
  EXPECT_NE(errorOf("image,slide\na.png,nan\n").find("is not finite"), std::string::npos);
  EXPECT_NE(errorOf("image,slide\n").find("has no stops"), std::string::npos);
  EXPECT_THROW(loadStopList("/nowhere/stops.csv"), Error);
}

}  // namespace
}  // namespace vibe::vision::stop_list_test
