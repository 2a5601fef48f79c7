#pragma once
#include <string>

namespace vibe {

/// File that an address means. "package://NAME/FILE" is looked up in this order:
/// 1. in the folders of the environment variable ROS_PACKAGE_PATH (folders of packages, or a package itself),
/// 2. in PREFIX/share/NAME of each prefix in the environment variable CMAKE_PREFIX_PATH,
/// 3. in PREFIX/share/NAME of the prefix under which the running program or this library is installed.
/// A folder is a package if it has a package.xml. Every other address is a path already. Needs no ROS.
/// @throws Error if no folder has such a package
std::string resolveAddress(const std::string& address);

/// The whole text of a file.
/// @param what  what to call it in the error, e.g. "URDF"
/// @throws Error if it cannot be read
std::string readTextFile(const std::string& file, const std::string& what);

}  // namespace vibe
