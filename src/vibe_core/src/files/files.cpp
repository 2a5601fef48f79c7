#include "vibe_core/files/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

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

// From memory to the disk; a file system that cannot is none that loses power.
bool flush(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool flushed = ::fsync(descriptor) == 0 || errno == EINVAL;
  ::close(descriptor);
  return flushed;
}

}  // namespace

WholeFile::WholeFile(std::string file, std::string what) : file_(std::move(file)), what_(std::move(what)) {
  std::error_code unknown;
  target_ = std::filesystem::weakly_canonical(file_, unknown);
  if (target_.empty()) target_ = file_;
  is_special_ = std::filesystem::exists(target_, unknown) && !std::filesystem::is_regular_file(target_, unknown);
  part_ = is_special_ ? target_ : target_.parent_path() / (".part-" + target_.filename().string());
}

WholeFile::~WholeFile() {
  if (!is_special_ && !is_finished_) std::remove(part_.c_str());
}

void WholeFile::finish(bool written) {
  if (!written || (!is_special_ && !flush(part_)))
    throw Error(what_ + " '" + file_ + "' could not be written; check that the folder exists and has room.");
  if (!is_special_ && std::rename(part_.c_str(), target_.c_str()) != 0)
    throw Error(what_ + " '" + file_ + "' could not be put in place; check the permissions of its folder.");
  is_finished_ = true;
  if (!is_special_) flush(target_.parent_path());
}

void writeWhole(const std::string& file, const std::function<bool(const std::string& part)>& write,
                const std::string& what) {
  WholeFile whole(file, what);
  whole.finish(write(whole.part()));
}

void writeFile(const std::string& file, const std::string& content, const std::string& what) {
  const auto write = [&content](const std::string& part) {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    out << content;
    out.close();
    return static_cast<bool>(out);
  };
  writeWhole(file, write, what);
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
