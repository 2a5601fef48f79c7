#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <sys/types.h>

namespace vibe::hardware {

/// A program that runs as long as the object lives.
class ChildProcess {
 public:
  /// @param command  program and arguments  @throws std::runtime_error
  explicit ChildProcess(const std::vector<std::string>& command);
  ~ChildProcess();  ///< asks it to end and waits for that
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  bool running() const;
  std::string ending() const;  ///< how it has ended: "runs", "exit status 1", "signal 11"

 private:
  pid_t pid_;
};

/// The test's place in the guest's ROS graph, whose master scripts/hid_kernel has started. Callbacks come in
/// waitUntil().
class RosGraph {
 public:
  RosGraph();  ///< waits for the master. @throws std::runtime_error after two minutes

  ros::NodeHandle& handle() { return handle_; }

  /// Starts a node of vibe_hardware with private parameters such as "_config:=FILE".
  static std::unique_ptr<ChildProcess> start(const std::string& node, const std::vector<std::string>& parameters);

  /// Handles messages until the condition holds. @param timeout [s]  @return whether it came to hold
  static bool waitUntil(const std::function<bool()>& condition, double timeout = 30);

 private:
  struct Connection {
    Connection();
  };

  Connection connection_;
  ros::NodeHandle handle_;
};

}  // namespace vibe::hardware
