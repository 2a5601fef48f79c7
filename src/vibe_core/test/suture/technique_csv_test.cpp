#include "vibe_core/suture/technique_table.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe::technique_csv_test {
namespace {

std::vector<std::vector<Eigen::Vector3d>> read(const std::string& text) {
  std::istringstream in(text);
  return readTechniqueCsv(in, "log.csv");
}

std::string errorOf(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TechniqueCsv, BlankLinesPartSetsAndCommentsDoNot) {
  const auto sets = read("\n# both\n1,2,3\n# still the first\n 4 , 5,6 # here too\n\n\n-7,+8,9e-1\n\n");
  ASSERT_EQ(sets.size(), 2u);
  ASSERT_EQ(sets[0].size(), 2u);
  EXPECT_EQ(sets[0][1], Eigen::Vector3d(4, 5, 6));
  ASSERT_EQ(sets[1].size(), 1u);
  EXPECT_EQ(sets[1][0], Eigen::Vector3d(-7, 8, 0.9));
}

TEST(TechniqueCsv, HeaderSaysWhichColumnsAreRead) {
  const auto sets = read("time,Z [m],x,y_m,note\n0.5,3,1,2,first bite\n");
  ASSERT_EQ(sets.size(), 1u);
  EXPECT_EQ(sets[0][0], Eigen::Vector3d(1, 2, 3));
}

TEST(TechniqueCsv, TakesFilesOfOtherSystems) {
  EXPECT_EQ(read("\xef\xbb\xbfx,y,z\r\n1,2,3\r\n\r\n4,5,6\r\n").size(), 2u);
}

TEST(TechniqueCsv, ErrorsNameThePlaceAndTheRemedy) {
  EXPECT_EQ(errorOf("1,2,3\n4,5\n"),
            "log.csv:2: the row has 2 columns instead of 3; write x,y,z with commas between them.");
  EXPECT_EQ(errorOf("x,y,z\n1,2,3,4\n"),
            "log.csv:2: the row has 4 columns instead of 3; write x,y,z with commas between them.");
  EXPECT_EQ(errorOf("1,2,3\n\n1,2,3 mm\n"), "log.csv:3: z '3 mm' is not a number; write it like 0.012 or 1.2e-2.");
  EXPECT_EQ(errorOf("1,,3\n"), "log.csv:1: y '' is not a number; write it like 0.012 or 1.2e-2.");
  EXPECT_EQ(errorOf("nan,nan,nan\n"), "log.csv:1: x 'nan' is not finite; correct the position or leave the bite out.");
  EXPECT_EQ(errorOf("1,inf,3\n"), "log.csv:1: y 'inf' is not finite; correct the position or leave the bite out.");
  EXPECT_EQ(errorOf("t,x,y\n1,2,3\n"), "log.csv:1: the header names no column 'z'; name x, y and z.");
  EXPECT_EQ(errorOf("1,2,3\nx,y,z\n"), "log.csv:2: x 'x' is not a number; write it like 0.012 or 1.2e-2.");
  EXPECT_EQ(errorOf(""), "log.csv holds no bite; give it a row x,y,z per bite.");
  EXPECT_EQ(errorOf("x,y,z\n# nothing\n"), "log.csv holds no bite; give it a row x,y,z per bite.");
  EXPECT_EQ(errorOf("1,2,1e999\n"), "log.csv:1: z '1e999' is not a number; write it like 0.012 or 1.2e-2.");
}

TEST(TechniqueCsv, SurvivesAnyBytes) {
  const std::string bytes("0123456789,,,\n\n#.-+exyz \t\r\"\xff\0n", 30);
  std::uint64_t random = 1;
  for (int k = 0; k < 2000; ++k) {
    std::string text;
    for (int length = 0; length < 40; ++length) {
      random = random * 6364136223846793005ULL + 1442695040888963407ULL;
      text += bytes[(random >> 33) % bytes.size()];
    }
    try {
      for (const auto& set : read(text)) EXPECT_FALSE(set.empty());
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace vibe::technique_csv_test
