#include "vibe_ros_utils/mesh_address.hpp"

#include <ros/package.h>

namespace vibe::ros_utils {

std::string fileOf(const std::string& address) {
  const std::string package = "package://", file = "file://";
  if (address.rfind(file, 0) == 0) return address.substr(file.size());
  if (address.rfind(package, 0) != 0) return address;
  const std::string rest = address.substr(package.size());
  const std::size_t slash = rest.find('/');
  return ros::package::getPath(rest.substr(0, slash)) + (slash == std::string::npos ? "" : rest.substr(slash));
}

}  // namespace vibe::ros_utils
