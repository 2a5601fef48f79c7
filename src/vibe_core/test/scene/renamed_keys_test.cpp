#include "scene/scene_keys.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/schema.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::renamed_keys_test {
namespace {

class EveryRenamedKey : public ::testing::TestWithParam<RenamedKey> {};

// A key inside a section stands on line 3 of the text, one of the top level on line 2.
TEST_P(EveryRenamedKey, IsAnErrorWithLineAndNewName) {
  const std::string key = GetParam().old_key, section = sectionOf(key);
  const std::string text =
      section.empty() ? "name: x\n" + key + ": 1\n" : "name: x\n" + section + ":\n  " + lastPart(key) + ": 1\n";
  const std::string place = section.empty() ? "dir/s.yaml:2: " : "dir/s.yaml:3: ";
  EXPECT_EQ(errorOf([&] { parseScene(text, "dir/s.yaml"); }),
            place + key + ": has a new name; write it as '" + GetParam().new_key + "'");
}

// Otherwise the advice would lead to the next error, or the old name would hide a key that exists.
TEST_P(EveryRenamedKey, LeadsToAKeyThatExistsFromOneThatDoesNot) {
  const auto exists = [](const std::string& key) { return findRow(key) != nullptr || findSection(key) != nullptr; };
  EXPECT_TRUE(exists(GetParam().new_key));
  EXPECT_FALSE(exists(GetParam().old_key));
}

TEST_P(EveryRenamedKey, IsInTheDocumentation) {
  std::stringstream page;
  page << std::ifstream(std::string(VIBE_CORE_DIR) + "/../../docs/scenes.md").rdbuf();
  const std::string row = std::string("| `") + GetParam().old_key + "` | `" + GetParam().new_key + "` |";
  EXPECT_NE(page.str().find(row), std::string::npos) << "docs/scenes.md lacks the row " << row;
}

INSTANTIATE_TEST_SUITE_P(Scene, EveryRenamedKey, ::testing::ValuesIn(renamedKeys()),
                         [](const ::testing::TestParamInfo<RenamedKey>& row) {
                           std::string name = row.param.old_key;
                           for (char& c : name) c = c == '.' ? '_' : c;
                           return name;
                         });

// Control: a key that never existed gets the usual hint.
TEST(RenamedKeys, OtherUnknownKeysKeepTheHint) {
  EXPECT_EQ(newNameOf("suture.pullin"), nullptr);
  EXPECT_EQ(newNameOf("pulling"), nullptr);
  EXPECT_ERROR(parseScene("suture: {cinch_modell: thread}", "s.yaml"), "did you mean 'cinch_model'?");
}

}  // namespace
}  // namespace vibe::renamed_keys_test
