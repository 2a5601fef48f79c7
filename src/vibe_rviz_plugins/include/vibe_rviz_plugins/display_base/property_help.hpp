#pragma once
#include <string>
#include <vector>

namespace rviz {
class Property;
}

namespace vibe::rviz_plugins {

/// Which properties explain themselves.
struct PropertyHelp {
  int count = 0;                     ///< properties found, statuses aside
  std::vector<std::string> missing;  ///< paths of those without a help sentence, such as "Sutures/Legend"
};

/// Checks all properties below `parent`, a display for example. Every property of this project has a help sentence,
/// and tests use this function to make sure.
/// @param path  name of the parent, which the paths begin with
PropertyHelp checkPropertyHelp(const rviz::Property& parent, const std::string& path);

}  // namespace vibe::rviz_plugins
