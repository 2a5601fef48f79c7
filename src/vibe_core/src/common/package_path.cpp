#include "vibe_core/common/package_path.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "common/own_place.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

const std::string kScheme = "package://";

std::vector<std::filesystem::path> foldersOf(const char* variable) {
  std::vector<std::filesystem::path> folders;
  const char* value = std::getenv(variable);
  std::istringstream list(value == nullptr ? "" : value);
  for (std::string folder; std::getline(list, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  return folders;
}

std::filesystem::path findPackage(const std::string& package) {
  std::vector<std::filesystem::path> candidates;
  for (const auto& folder : foldersOf("ROS_PACKAGE_PATH")) {
    candidates.push_back(folder / package);
    if (folder.filename() == package) candidates.push_back(folder);
  }
  for (const auto& prefix : foldersOf("CMAKE_PREFIX_PATH")) candidates.push_back(prefix / "share" / package);
  for (const auto& prefix : ownPrefixes()) candidates.push_back(prefix / "share" / package);
  for (const auto& candidate : candidates)
    if (std::filesystem::exists(candidate / "package.xml")) return candidate;
  throw Error(
      "There is no package '" + package +
      "' in ROS_PACKAGE_PATH, in CMAKE_PREFIX_PATH or where this program is installed; source the setup.bash of "
      "the workspace that has it, or set CMAKE_PREFIX_PATH to the prefix under which it is installed.");
}

}  // namespace

std::string resolveAddress(const std::string& address) {
  if (address.compare(0, kScheme.size(), kScheme) != 0) return address;
  const std::size_t slash = address.find('/', kScheme.size());
  const std::filesystem::path folder = findPackage(address.substr(kScheme.size(), slash - kScheme.size()));
  return slash == std::string::npos ? folder.string() : (folder / address.substr(slash + 1)).string();
}

std::string readTextFile(const std::string& file, const std::string& what) {
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream || stream.bad()) throw Error("Cannot read the " + what + " '" + file + "'; check path and permissions.");
  return text;
}

}  // namespace vibe
