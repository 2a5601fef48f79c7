#pragma once
#include <string>

namespace vibe {

/// File that an address means: "package://NAME/FILE" is looked up in the folders of the environment variables
/// ROS_PACKAGE_PATH (folders of packages, or a package itself) and CMAKE_PREFIX_PATH (share/NAME), everything else is
/// a path already. Knows no ROS, so that programs without a ROS graph find what scenes name.
/// @throws Error if no folder has such a package
std::string resolveAddress(const std::string& address);

/// The whole text of a file.
/// @param what  what to call it in the error, e.g. "URDF"
/// @throws Error if it cannot be read
std::string readTextFile(const std::string& file, const std::string& what);

}  // namespace vibe
