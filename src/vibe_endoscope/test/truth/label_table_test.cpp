#include "truth/label_table.hpp"

#include <gtest/gtest.h>

#include <set>

namespace vibe::endoscope::label_table_test {
namespace {

TEST(LabelTable, NumbersAndNamesAreUniqueAndTheTextNamesThemAll) {
  const std::vector<LabelEntry> table = labelTable({"scope_shaft", "helix/coil"});
  const std::string text = labelText(table);
  std::set<int> numbers;
  std::set<std::string> names;
  for (const LabelEntry& entry : table) {
    EXPECT_TRUE(numbers.insert(entry.number).second) << int{entry.number};
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_NE(text.find("{\"number\": " + std::to_string(entry.number) + ", \"name\": \"" + entry.name + "\""),
              std::string::npos);
  }
  EXPECT_EQ(table.size(), 1u + 80 + 4 + 5 + 2);
  EXPECT_EQ(table.back().number, kLabelInstrument + 1);
}

// Data sets that are written today must be readable tomorrow.
TEST(LabelTable, NumbersAreThoseOfTheDocumentation) {
  EXPECT_EQ(wallLabel(0, 0, 0), 1);
  EXPECT_EQ(wallLabel(2, 3, 0), 12);
  EXPECT_EQ(wallLabel(4, 3, 3), 80);
  EXPECT_EQ(wallLabel(1, 2, 1), 27);
  EXPECT_EQ(wallLabel(-1, 0, 2), 83);
  EXPECT_EQ(wallLabel(0, 9, 9), 84);
  EXPECT_EQ(kLabelThread, 100);
  EXPECT_EQ(kLabelBlood, 103);
  EXPECT_EQ(labelTable({})[27].number, 27);
  EXPECT_EQ(labelTable({})[27].name, "fundus posterior mark");
}

}  // namespace
}  // namespace vibe::endoscope::label_table_test
