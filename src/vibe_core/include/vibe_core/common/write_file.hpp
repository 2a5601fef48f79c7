#pragma once
#include <string>

namespace vibe {

/// Writes a file as a whole or not at all: FILE.part beside it takes its place once it is complete. What is not an
/// ordinary file, such as /dev/stdout, is written directly.
/// @param what  name used in the error message, e.g. "Snapshot"
/// @throws Error if it cannot be written; what was there before is there still, and no FILE.part is left
void writeFile(const std::string& file, const std::string& content, const std::string& what);

}  // namespace vibe
