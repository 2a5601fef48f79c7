#pragma once

#include <memory>
#include <string>

#include <ros/node_handle.h>

#include "vibe_hardware/gamepad/pad_mapping.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware {

/// A pad that another node reads and publishes as sensor_msgs/Joy, such as joy_node: it is there while the topic has a
/// publisher and from its first message on. Its controls bear the names that the mapping gives to the numbers of the
/// message. Half a
/// second after its last message sticks and buttons count as let go, because its node may hang. Rumble goes to
/// <topic>/set_feedback as sensor_msgs/JoyFeedbackArray.
/// @return for PadLink
PadLink::Open joyPad(ros::NodeHandle handle, const std::string& topic, const JoyNames& names);

}  // namespace vibe::hardware
