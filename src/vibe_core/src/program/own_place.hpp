#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace vibe {

/// Folders of the running program and of the file that contains this library, without duplicates. They locate files
/// installed beside them without environment variables, even if the installation has been moved.
std::vector<std::filesystem::path> ownFolders();

/// Prefixes under which the program and the library may be installed: their folders and the three folders above each,
/// because programs are in PREFIX/bin or PREFIX/lib/NAME and libraries in PREFIX/lib or PREFIX/lib/ARCHITECTURE.
std::vector<std::filesystem::path> ownPrefixes();

}  // namespace vibe
