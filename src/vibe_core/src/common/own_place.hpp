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

/// Path of a program of this library, e.g. "vibe_mesh_reader". Searches beside the running program, beside the library,
/// in the folder vibe_core beside the library, and in PREFIX/bin.
/// @returns an empty path if it is not found
std::filesystem::path findOwnProgram(const std::string& name);

}  // namespace vibe
