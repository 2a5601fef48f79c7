#pragma once

#include <array>
#include <optional>

#include <ros/node_handle.h>

#include "protocol/command.hpp"
#include "server/web_server.hpp"

namespace vibe::web {

/// Head and hands of the person who drives in a headset: as topics, and for the pages that look on.
class ViewerTopics {
 public:
  explicit ViewerTopics(ros::NodeHandle& handle);

  /// From the page that drives; the newest counts.
  void receive(const ViewerState& viewer) { received_ = viewer; }

  /// Publishes what has come, 60 times a second at most; pages no longer show who is silent. @param now  steady [s]
  void tick(double now, WebServer& server);

 private:
  void publish(const ViewerState& viewer);

  std::array<ros::Publisher, kViewerBodies> poses_;
  ros::Publisher buttons_;
  std::optional<ViewerState> received_;
  double last_ = 0;
  bool shown_ = false;
};

}  // namespace vibe::web
