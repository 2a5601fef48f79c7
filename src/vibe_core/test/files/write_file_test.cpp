#include "vibe_core/files/files.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "vibe_core/program/error.hpp"
#include "vibe_testing/temporary_folder.hpp"

namespace vibe::write_file_test {
namespace {

namespace fs = std::filesystem;

TEST(WriteFile, ReplacesWhatWasThereAndLeavesNothingElse) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() + "/state";
  writeFile(file, "a long first version", "File");
  writeFile(file, std::string("new\0er", 6), "File");
  EXPECT_EQ(readTextFile(file, "file"), std::string("new\0er", 6));
  EXPECT_FALSE(fs::exists(folder.path() + "/.part-state"));
}

TEST(WriteFile, ALinkStaysALink) {
  const test::TemporaryFolder folder;
  const std::string file = folder.path() + "/state", link = folder.path() + "/link";
  writeFile(file, "old", "File");
  fs::create_symlink(file, link);
  writeFile(link, "new", "File");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(readTextFile(file, "file"), "new");
}

TEST(WriteFile, SaysWhatCannotBeWritten) {
  for (const char* file : {"/nowhere/at/all", "/dev/full", "/proc/self/status"}) {
    try {
      writeFile(file, "text", "Snapshot");
      ADD_FAILURE() << file;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).rfind("Snapshot '" + std::string(file) + "' could not be", 0), 0u)
          << error.what();
    }
  }
}

TEST(WriteFile, WritesToWhatIsNoFile) {
  EXPECT_NO_THROW(writeFile("/dev/null", "text", "File"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace vibe::write_file_test
