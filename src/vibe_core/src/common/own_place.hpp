#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace vibe {

/// Folders of the running program and of the file that holds this library, without duplicates. They lead to what is
/// installed beside them, without environment variables and wherever the installation has been moved to.
std::vector<std::filesystem::path> ownFolders();

/// Prefixes under which the program and the library may be installed: their folders and the three folders above each,
/// because programs are in PREFIX/bin or PREFIX/lib/NAME and libraries in PREFIX/lib or PREFIX/lib/ARCHITECTURE.
std::vector<std::filesystem::path> ownPrefixes();

/// A program of this library, e.g. "vibe_mesh_reader": beside the running program, beside the library, in the folder
/// vibe_core beside the library, or in PREFIX/bin.
/// @returns an empty path if it is in none of them
std::filesystem::path findOwnProgram(const std::string& name);

}  // namespace vibe
