#include "vibe_rviz_plugins/display_base/property_help.hpp"

#include <rviz/properties/status_property.h>

namespace vibe::rviz_plugins {

PropertyHelp checkPropertyHelp(const rviz::Property& parent, const std::string& path) {
  PropertyHelp help;
  for (int i = 0; i < parent.numChildren(); ++i) {
    const rviz::Property& child = *parent.childAtUnchecked(i);
    if (dynamic_cast<const rviz::StatusProperty*>(&child) != nullptr) continue;
    const std::string name = path + "/" + child.getName().toStdString();
    ++help.count;
    if (child.getDescription().trimmed().isEmpty()) help.missing.push_back(name);
    const PropertyHelp below = checkPropertyHelp(child, name);
    help.count += below.count;
    help.missing.insert(help.missing.end(), below.missing.begin(), below.missing.end());
  }
  return help;
}

}  // namespace vibe::rviz_plugins
