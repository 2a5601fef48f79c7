#include "vibe_core/files/csv_row.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::csv_row_test {
namespace {

TEST(CsvRow, HasOneCellMoreThanCommas) {
  EXPECT_EQ(cellsOf(""), (std::vector<std::string>{""}));
  EXPECT_EQ(cellsOf(" a b ,,\t3\r"), (std::vector<std::string>{"a b", "", "3"}));
  EXPECT_EQ(cellsOf(","), (std::vector<std::string>{"", ""}));
}

TEST(CsvRow, ACellIsANumberAsAWholeOnly) {
  EXPECT_EQ(numberOf("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(numberOf("+2"), 2);
  EXPECT_TRUE(std::isnan(numberOf("nan").value()));
  for (const char* none : {"", "+", "+-1", "1,5", "1 2", "0x10", "1e400", "x"}) EXPECT_FALSE(numberOf(none)) << none;
}

}  // namespace
}  // namespace vibe::csv_row_test
