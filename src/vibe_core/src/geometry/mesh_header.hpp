#pragma once
#include <string>

namespace vibe {

/// Checks what the beginning of a mesh file promises against its size, before it is read in full: the reader of the
/// import library does not end, or asks for all memory, on some damaged headers.
/// @param type lower-case extension with its dot; files of a type without header are accepted
/// @throws Error naming the file, the place and the remedy.
void checkMeshHeader(const std::string& path, const std::string& type);

}  // namespace vibe
