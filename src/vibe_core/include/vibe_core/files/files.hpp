#pragma once

#include <string>

namespace vibe {

/// Resolves an address to a file path. "package://NAME/FILE" is looked up in this order: 1. in the folders of the
/// environment variable ROS_PACKAGE_PATH (folders of packages, or a package itself), 2. in PREFIX/share/NAME of each
/// prefix in the environment variable CMAKE_PREFIX_PATH, 3. in PREFIX/share/NAME of the prefix under which the running
/// program or this library is installed, 4. below the folders of ROS_PACKAGE_PATH, to a depth of five, for a
/// package.xml with this name. A folder is a package if it contains a package.xml. Any other address is returned as a
/// path. Does not need ROS.
/// @throws Error if no folder contains such a package
std::string resolveAddress(const std::string& address);

/// Reads a text file as a whole.
/// @param what  name used in the error message, e.g. "URDF"
/// @throws Error if it cannot be read
std::string readTextFile(const std::string& file, const std::string& what);

/// Writes a file as a whole or not at all: FILE.part beside it takes its place once it is complete. What is not an
/// ordinary file, such as /dev/stdout, is written directly.
/// @param what  name used in the error message, e.g. "Snapshot"
/// @throws Error if it cannot be written; what was there before is there still, and no FILE.part is left
void writeFile(const std::string& file, const std::string& content, const std::string& what);

}  // namespace vibe
