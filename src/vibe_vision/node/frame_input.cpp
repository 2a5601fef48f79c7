#include "frame_input.hpp"

#include "vibe_core/common/error.hpp"
#include "vision_messages.hpp"

namespace vibe::vision {
namespace {

constexpr double kComplaintPeriod = 1;  // [s]

}  // namespace

TopicInput::TopicInput(ros::NodeHandle handle, ros::NodeHandle private_handle, const VisionParameters& parameters)
    : exposure_(parameters.options.exposure), start_stamped_(parameters.start_stamped), transport_(handle) {
  const image_transport::TransportHints hints("raw", ros::TransportHints().tcpNoDelay(), private_handle);
  topic_ = handle.resolveName("image");
  subscriber_ = transport_.subscribeCamera("image", 1, &TopicInput::onImage, this, hints);
}

void TopicInput::onImage(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfoConstPtr& info) {
  try {
    Frame frame = makeFrame(image, *info, exposure_, start_stamped_);
    frame.arrival = ros::Time::now().toSec();
    count(frame.sequence);
    latest_.put(std::move(frame));
  } catch (const Error& error) {
    refuse(error.what());
  }
}

void TopicInput::count(std::uint64_t sequence) {
  const std::lock_guard<std::mutex> lock(mutex_);
  // a publisher that starts anew counts from the beginning
  const bool gap = statistics_.frames > 0 && sequence > last_sequence_ + 1;
  if (gap) statistics_.lost += sequence - last_sequence_ - 1;
  last_sequence_ = sequence;
  ++statistics_.frames;
  complaint_.clear();
}

void TopicInput::refuse(const std::string& complaint) {
  ROS_WARN_STREAM_THROTTLE(kComplaintPeriod, "A message on " << topic_ << " is ignored: " << complaint);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++statistics_.unreadable;
  complaint_ = complaint;
}

ReadResult TopicInput::take(Frame& frame, double timeout) {
  return latest_.take(frame, timeout);
}

SourceStatistics TopicInput::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return statistics_;
}

std::uint64_t TopicInput::dropped() const {
  return latest_.dropped();
}

std::string TopicInput::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!complaint_.empty()) return complaint_;
  if (statistics_.frames > 0) return "Images of " + topic_ + ".";
  return "No image with its camera_info has arrived on " + topic_ + "; remap 'image' to the topic of the camera.";
}

}  // namespace vibe::vision
