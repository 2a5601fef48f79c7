#include "program_options.hpp"

#include <gtest/gtest.h>
#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::program_options_test {
namespace {

TEST(ProgramOptions, LengthsHaveUnitsOrAreInMetres) {
  EXPECT_DOUBLE_EQ(lengthOption("--square", "5mm"), 5e-3);
  EXPECT_DOUBLE_EQ(lengthOption("--square", "0.004"), 4e-3);
  EXPECT_EQ(errorOf([] { lengthOption("--square", "5 deg"); }).rfind("--square: '5 deg' is an angle", 0), 0U);
  EXPECT_ERROR(lengthOption("--square", "-1 mm"), "is out of range");
  EXPECT_ERROR(lengthOption("--square", "5"), "is out of range");
}

TEST(ProgramOptions, BoardsAreTwoWholeNumbers) {
  const BoardSpec board = boardOption("7x5", "8 mm");
  EXPECT_EQ(board.columns, 7);
  EXPECT_EQ(board.rows, 5);
  EXPECT_DOUBLE_EQ(board.square, 8e-3);
  for (const char* const wrong : {"7", "7x", "7x5x3", "a", "7by5"})
    EXPECT_NE(errorOf([wrong] { boardOption(wrong, "5 mm"); }).find("is not a chessboard"), std::string::npos) << wrong;
}

}  // namespace
}  // namespace vibe::vision::program_options_test
