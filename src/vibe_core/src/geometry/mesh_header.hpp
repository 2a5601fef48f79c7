#pragma once
#include <string>

namespace vibe {

/// Checks the header of a mesh file against the file size before the file is read in full. On some damaged headers the
/// reader of the import library does not terminate, or requests all memory.
/// @param type lower-case extension with its dot; files of a type without header are accepted
/// @throws Error naming the file, the place and the remedy.
void checkMeshHeader(const std::string& path, const std::string& type);

}  // namespace vibe
