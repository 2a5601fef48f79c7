#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <ros/node_handle.h>

#include "operator/operator_seat.hpp"
#include "server/web_server.hpp"
#include "vibe_operator/driving/manual_drive.hpp"
#include "viewer_topics.hpp"

namespace vibe::web {

/// Lets one page drive, with the same keys, speeds and topics as the tool 'Drive scope' of rviz.
class OperatorDrive {
 public:
  explicit OperatorDrive(ros::NodeHandle& handle);

  // For the server, from its thread: taken up by tick().
  void receive(ClientId client, const Command& command);
  void leave(ClientId client);

  /// A hundred times a second, in the thread of the node.
  /// @param recording  is shown, and has nothing to drive
  void tick(WebServer& server, bool recording);
  /// Releases everything and waits until the simulator has heard of it.
  void goodbye();

 private:
  void obey(ClientId client, const Command& command, WebServer& server);
  void takeSeat(ClientId client, WebServer& server);
  void replay(const Command& command);
  void passKeys();
  void moveAxes(double seconds);
  void publish(WebServer& server);

  std::mutex mutex_;  // of what was received and not taken up
  std::vector<std::pair<ClientId, Command>> received_;
  std::vector<ClientId> left_;

  OperatorSeat seat_;
  operating::ManualDrive drive_;
  ros::Publisher replay_;
  ViewerTopics viewer_;
  std::set<int> down_;  // keys that drive_ knows of
  bool started_ = false;
  std::uint32_t seats_ = 0;  // how often the seat was taken
  double last_ = 0, ticked_ = 0;
  std::string published_;
};

}  // namespace vibe::web
