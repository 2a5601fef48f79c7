#pragma once
#include <ros/node_handle.h>

#include <cstdint>

#include "vibe_core/input/step_input.hpp"

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
  ros::Publisher scope_, overstitch_, buttons_;
};

}  // namespace vibe::sim
