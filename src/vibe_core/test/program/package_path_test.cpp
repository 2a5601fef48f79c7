#include "vibe_core/files/files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "environment_variable.hpp"
#include "program/own_place.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/temporary_folder.hpp"

namespace vibe::package_path_test {
namespace {

namespace fs = std::filesystem;
using test::EnvironmentVariable;
using test::TemporaryFolder;

class PackagePath : public ::testing::Test {
 protected:
  static void makePackage(const fs::path& folder) {
    fs::create_directories(folder);
    std::ofstream(folder / "package.xml") << "<package/>\n";
  }

  // what a plain shell has: neither ROS nor a workspace
  EnvironmentVariable no_ros{"ROS_PACKAGE_PATH", {}};
  EnvironmentVariable no_cmake{"CMAKE_PREFIX_PATH", {}};
  TemporaryFolder folder;
};

TEST_F(PackagePath, leavesEveryOtherAddressAsItIs) {
  EXPECT_EQ(resolveAddress("scenes/stomach.yaml"), "scenes/stomach.yaml");
  EXPECT_EQ(resolveAddress("/package://a"), "/package://a");
}

TEST_F(PackagePath, findsAPackageInRosPackagePathFirst) {
  makePackage(folder.path() + "/source/a");
  makePackage(folder.path() + "/prefix/share/a");
  const EnvironmentVariable cmake("CMAKE_PREFIX_PATH", folder.path() + "/prefix");
  EXPECT_EQ(resolveAddress("package://a/x/y"), folder.path() + "/prefix/share/a/x/y");
  EXPECT_EQ(resolveAddress("package://a"), folder.path() + "/prefix/share/a");
  const EnvironmentVariable ros("ROS_PACKAGE_PATH", folder.path() + "/none:" + folder.path() + "/source");
  EXPECT_EQ(resolveAddress("package://a/x/y"), folder.path() + "/source/a/x/y");
  const EnvironmentVariable itself("ROS_PACKAGE_PATH", folder.path() + "/source/a");
  EXPECT_EQ(resolveAddress("package://a/x/y"), folder.path() + "/source/a/x/y");
}

TEST_F(PackagePath, findsAPackageInAFolderOfAnotherName) {
  const std::string named = folder.path() + "/source/group/other";
  makePackage(folder.path() + "/source/a_first");
  makePackage(named);
  std::ofstream(named + "/package.xml") << "<package>\n  <name> a </name>\n</package>\n";
  const EnvironmentVariable ros("ROS_PACKAGE_PATH", folder.path() + "/source");
  EXPECT_EQ(resolveAddress("package://a/x/y"), named + "/x/y");
  EXPECT_THROW(resolveAddress("package://other2/x"), Error);
  std::ofstream(folder.path() + "/source/group/CATKIN_IGNORE") << "";
  EXPECT_THROW(resolveAddress("package://a/x/y"), Error);
}

TEST_F(PackagePath, findsAPackageInThePrefixOfTheProgramWithoutAnyVariable) {
  const std::string name = "vibe_test_package_" + std::to_string(getpid());
  EXPECT_THROW(resolveAddress("package://" + name), Error);  // control: it is not found before it is there
  const fs::path prefix = fs::canonical("/proc/self/exe").parent_path();
  const bool had_share = fs::exists(prefix / "share");
  makePackage(prefix / "share" / name);
  const std::string found = resolveAddress("package://" + name + "/a.yaml");
  fs::remove_all(had_share ? prefix / "share" / name : prefix / "share");
  EXPECT_EQ(found, (prefix / "share" / name / "a.yaml").string());
}

TEST_F(PackagePath, takesAFolderForAPackageOnlyIfItHasAPackageXml) {
  fs::create_directories(folder.path() + "/prefix/share/a");
  const EnvironmentVariable cmake("CMAKE_PREFIX_PATH", folder.path() + "/prefix");
  EXPECT_THROW(resolveAddress("package://a/x"), Error);
}

TEST_F(PackagePath, saysWhereItHasLooked) {
  try {
    resolveAddress("package://no_such_package/x");
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string said = error.what();
    for (const char* place : {"'no_such_package'", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH", "is installed"})
      EXPECT_NE(said.find(place), std::string::npos) << place << " is missing in: " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
  }
}

TEST(OwnPlace, isThatOfTheProgramAndOfTheLibrary) {
  const fs::path program = fs::canonical("/proc/self/exe").parent_path();
  ASSERT_FALSE(ownFolders().empty());
  EXPECT_EQ(ownFolders()[0], program);
  const auto prefixes = ownPrefixes();
  for (const fs::path& prefix : {program, program.parent_path(), program.parent_path().parent_path()})
    EXPECT_NE(std::find(prefixes.begin(), prefixes.end(), prefix), prefixes.end()) << prefix;
}

}  // namespace
}  // namespace vibe::package_path_test
