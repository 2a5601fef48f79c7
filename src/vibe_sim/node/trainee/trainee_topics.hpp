#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <ros/node_handle.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/StepResult.h>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/trainee/observation.hpp"

namespace vibe::sim {

/// Time that stands still for so long shows that something that was sent may have been lost [s].
constexpr double kResendAfter = 0.5;

/// Publishes inputs on the topics of the devices.
class InputSender {
 public:
  explicit InputSender(ros::NodeHandle handle);

  /// Whether somebody receives all three topics.
  bool hasListeners() const;
  /// @param stamp         of the sample [ns]
  /// @param with_buttons  else only the joints
  void send(const StepInput& input, std::int64_t stamp, bool with_buttons = true);
  void sendButtons(const StepInput& input, std::int64_t stamp);

 private:
  ros::Publisher scope_, suturing_device_, buttons_;
};

/// What a trainee perceived after one step, and when.
struct Sight {
  Observation seen;
  std::int64_t stamp = 0;      ///< of the end of the step [ns]
  std::uint32_t revision = 0;  ///< of the topology
};

/// Puts together the messages of a step, which arrive on two topics in any order.
class ObservationQueue {
 public:
  /// @param complete  wait for the particles of each step that has some, so that what is perceived does not depend on
  ///                  when messages arrive; else use the newest
  explicit ObservationQueue(bool complete) : complete_(complete) {}

  void push(const vibe_msgs::StepResult::ConstPtr& result);
  void push(const sensor_msgs::PointCloud2::ConstPtr& cloud);

  /// The next step in order; empty: not everything of it is here.
  /// @throws Error if the cloud cannot be read; it is dropped
  std::optional<Sight> next();

 private:
  bool complete_;
  std::deque<vibe_msgs::StepResult::ConstPtr> results_;
  std::deque<sensor_msgs::PointCloud2::ConstPtr> clouds_;

  bool findCloud(const vibe_msgs::StepResult& result);
  std::vector<Eigen::Vector3d> takeWall();
};

}  // namespace vibe::sim
