#include "vibe_core/files/files.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>
#include <vector>

#include <dlfcn.h>

#include "program/own_place.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

const std::string kScheme = "package://";
constexpr int kDepth = 5;  // of folders below one of ROS_PACKAGE_PATH

std::vector<std::filesystem::path> foldersOf(const char* variable) {
  std::vector<std::filesystem::path> folders;
  const char* value = std::getenv(variable);
  std::istringstream list(value == nullptr ? "" : value);
  for (std::string folder; std::getline(list, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  return folders;
}

bool isPackage(const std::filesystem::path& folder, const std::string& name) {
  std::ifstream stream(folder / "package.xml");
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  std::smatch found;
  return std::regex_search(text, found, std::regex("<name>\\s*([^<\\s]*)\\s*</name>")) && found[1] == name;
}

/// Like rospack: a package is called what its package.xml says, wherever it lies; packages do not lie in packages.
std::optional<std::filesystem::path> searchPackage(const std::filesystem::path& folder, const std::string& package,
                                                   int depth) {
  std::error_code unreadable;
  if (std::filesystem::exists(folder / "package.xml", unreadable)) {
    if (isPackage(folder, package)) return folder;
    return std::nullopt;
  }
  if (depth == 0 || std::filesystem::exists(folder / "CATKIN_IGNORE", unreadable)) return std::nullopt;
  std::vector<std::filesystem::path> below;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable))
    if (entry.is_directory(unreadable) && entry.path().filename().string()[0] != '.') below.push_back(entry.path());
  std::sort(below.begin(), below.end());
  for (const auto& next : below)
    if (auto found = searchPackage(next, package, depth - 1)) return found;
  return std::nullopt;
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
  for (const auto& folder : foldersOf("ROS_PACKAGE_PATH"))
    if (const auto found = searchPackage(folder, package, kDepth)) return *found;
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

namespace {

bool write(const std::string& file, const std::string& content) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << content;
  out.close();
  return static_cast<bool>(out);
}

}  // namespace

void writeFile(const std::string& file, const std::string& content, const std::string& what) {
  std::error_code unknown;
  const std::filesystem::path target = std::filesystem::weakly_canonical(file, unknown);  // a link stays a link
  const bool special = std::filesystem::exists(target, unknown) && !std::filesystem::is_regular_file(target, unknown);
  const std::string place = target.empty() ? file : target.string(), part = special ? place : place + ".part";
  if (!write(part, content)) {
    if (!special) std::remove(part.c_str());
    throw Error(what + " '" + file + "' could not be written; check that the folder exists and has room.");
  }
  if (special || std::rename(part.c_str(), place.c_str()) == 0) return;
  std::remove(part.c_str());
  throw Error(what + " '" + file + "' could not be put in place; check the permissions of its folder.");
}

namespace fs = std::filesystem;

namespace {

constexpr int kLevels = 3;  // from PREFIX/lib/ARCHITECTURE or PREFIX/lib/NAME up to PREFIX, plus one

void addOnce(std::vector<fs::path>& paths, const fs::path& path) {
  if (!path.empty() && std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
}

fs::path folderOf(const fs::path& file) {
  std::error_code none;
  const fs::path real = fs::canonical(file, none);
  return none ? fs::path() : real.parent_path();
}

// in a program that links the library statically, this is the program
fs::path libraryFile() {
  Dl_info info{};
  const auto address = reinterpret_cast<const void*>(&ownFolders);
  return dladdr(address, &info) != 0 && info.dli_fname != nullptr ? fs::path(info.dli_fname) : fs::path();
}

}  // namespace

std::vector<fs::path> ownFolders() {
  std::vector<fs::path> folders;
  addOnce(folders, folderOf("/proc/self/exe"));
  addOnce(folders, folderOf(libraryFile()));
  return folders;
}

std::vector<fs::path> ownPrefixes() {
  std::vector<fs::path> prefixes;
  for (fs::path folder : ownFolders()) {
    for (int level = 0; level <= kLevels; ++level, folder = folder.parent_path()) addOnce(prefixes, folder);
  }
  return prefixes;
}

}  // namespace vibe
