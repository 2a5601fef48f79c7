#pragma once
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/single_subscriber_publisher.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <string>

// Names that topics had in the release before. They keep working in this one, and whoever uses one is told the present
// name once. With the next release this file and its uses go.

namespace vibe::ros_utils {

/// The former name of a topic that a simulator or tracker publishes; empty: it had no other.
std::string formerOutput(const std::string& present);
/// The former name of a topic that a simulator or device node listens to; empty: it had no other.
std::string formerInput(const std::string& present);
/// The present name of an input; the same name if it is no former one.
std::string presentInput(const std::string& name);
/// The present name of an output; the same name if it is no former one.
std::string presentOutput(const std::string& name);
/// Whether a topic, by its whole name, is an output by its former name, which says the same as that by the present one.
bool isFormerOutput(const std::string& whole);

/// scope/measured_js was an input and is the feedback of the simulated scope, which always has efforts. The joints that
/// a driver sends there have none.
inline bool isFormerInput(const sensor_msgs::JointState& message) {
  return message.effort.empty();
}

/// Says once for each former name who publishes it, and which name is the present one.
void warnOfFormerInput(const std::string& node, const std::string& former);
/// Says once for each former name who listens to it, and which name is the present one.
void warnOfFormerOutput(const std::string& node, const std::string& former);

/// Gives remappings of former names to the present ones, with a warning for each, before ros::init() reads them.
void renameRemappings(int argc, char** argv);

/// For a nodelet, whose remappings come with its handle.
/// @throws Error that names the present name of what is remapped
void refuseFormerRemappings(const ros::NodeHandle& handle);

/// Advertises the former name of an output, for those who still listen to it.
/// @return empty if there is none; publishing with it does nothing then
template <class M>
ros::Publisher advertiseFormer(ros::NodeHandle& handle, const std::string& present, std::uint32_t queue,
                               bool latch = false) {
  const std::string former = formerOutput(present);
  if (former.empty()) return {};
  const ros::SubscriberStatusCallback warn = [former](const ros::SingleSubscriberPublisher& listener) {
    warnOfFormerOutput(listener.getSubscriberName(), former);
  };
  return handle.advertise<M>(former, queue, warn, ros::SubscriberStatusCallback(), ros::VoidConstPtr(), latch);
}

}  // namespace vibe::ros_utils
