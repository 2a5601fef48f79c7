#include "common/own_place.hpp"

#include <dlfcn.h>

#include <algorithm>

namespace vibe {

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

fs::path findOwnProgram(const std::string& name) {
  std::vector<fs::path> candidates;
  for (const fs::path& folder : ownFolders()) {
    candidates.push_back(folder / name);
    candidates.push_back(folder / "vibe_core" / name);
  }
  for (const fs::path& prefix : ownPrefixes()) candidates.push_back(prefix / "bin" / name);
  std::error_code none;
  for (const fs::path& candidate : candidates)
    if (fs::is_regular_file(candidate, none)) return candidate;
  return {};
}

}  // namespace vibe
