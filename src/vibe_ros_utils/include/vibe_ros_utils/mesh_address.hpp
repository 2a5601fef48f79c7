#pragma once
#include <string>

namespace vibe::ros_utils {

/// The file of an address in a robot description. package://NAME/FILE is looked up as every ROS node does; file://FILE
/// and other addresses are paths. Where no package has that name, the result is the path without it, which does not
/// exist.
std::string fileOf(const std::string& address);

}  // namespace vibe::ros_utils
