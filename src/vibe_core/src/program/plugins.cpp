#include "program/plugins.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <mutex>
#include <sstream>

#include "program/own_place.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

std::string findPlugin(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  std::error_code none;
  for (const std::filesystem::path& folder : ownFolders())
    if (std::filesystem::is_regular_file(folder / name, none)) return (folder / name).string();
  return name;
}

// What the library registers as it is loaded may be refused.
void* loadPlugin(const std::string& name) {
  try {
    return dlopen(findPlugin(name).c_str(), RTLD_NOW);
  } catch (const Error& error) {
    throw Error("VIBE_PLUGINS names '" + name + "', which registers something that is refused: " + error.what());
  }
}

void loadAll() {
  const char* names = std::getenv("VIBE_PLUGINS");
  std::istringstream list(names == nullptr ? "" : names);
  for (std::string name; std::getline(list, name, ':');)
    if (!name.empty() && loadPlugin(name) == nullptr)
      throw Error("VIBE_PLUGINS names '" + name + "', which cannot be loaded (" + dlerror() +
                  "); build its package, or give the path of the library.");
}

}  // namespace

void loadPlugins() {
  static std::once_flag once;
  std::call_once(once, loadAll);
}

}  // namespace vibe
