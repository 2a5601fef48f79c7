#include "frame_input.hpp"

#include <ros/names.h>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {

TopicInput::TopicInput(ros::NodeHandle handle, const VisionParameters& parameters)
    : exposure_(parameters.options.exposure),
      start_stamped_(parameters.start_stamped),
      topic_(handle.resolveName("image")) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  info_subscriber_ =
      handle.subscribe(ros::names::parentNamespace(topic_) + "/camera_info", 1, &TopicInput::onInfo, this, hints);
  if (parameters.compressed) {
    topic_ += "/compressed";
    image_subscriber_ = handle.subscribe(topic_, 1, &TopicInput::onCompressed, this, hints);
  } else {
    image_subscriber_ = handle.subscribe(topic_, 1, &TopicInput::onImage, this, hints);
  }
}

void TopicInput::onCompressed(const sensor_msgs::CompressedImageConstPtr& message) {
  try {
    onImage(makeImage(*message));
  } catch (const Error& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    refuse(error.what());
  }
}

void TopicInput::onImage(const sensor_msgs::ImageConstPtr& image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (image_)
    refuse("An image came without a camera_info of the same stamp; publish both together, or no camera_info.");
  image_ = image;
  pair();
}

void TopicInput::onInfo(const sensor_msgs::CameraInfoConstPtr& info) {
  const std::lock_guard<std::mutex> lock(mutex_);
  info_ = info;
  pair();
}

/// Image and camera_info belong together by their stamps, whichever comes first. A camera that publishes no camera_info
/// has no region of interest.
void TopicInput::pair() {
  if (!image_) return;
  if (info_ && info_->header.stamp == image_->header.stamp) {
    use(*info_);
  } else if (info_subscriber_.getNumPublishers() == 0) {
    use({});
  }
}

void TopicInput::use(const sensor_msgs::CameraInfo& info) {
  try {
    Frame frame = makeFrame(image_, info, exposure_, start_stamped_, depth_);
    frame.arrival = ros::Time::now().toSec();
    count(frame.sequence);
    latest_.put(std::move(frame));
  } catch (const Error& error) {
    refuse(error.what());
  }
  image_.reset();
}

void TopicInput::count(std::uint64_t sequence) {
  // a publisher that starts anew counts from the beginning
  const bool gap = statistics_.frames > 0 && sequence > last_sequence_ + 1;
  if (gap) statistics_.lost += sequence - last_sequence_ - 1;
  last_sequence_ = sequence;
  ++statistics_.frames;
  complaint_.clear();
}

void TopicInput::refuse(const std::string& complaint) {
  constexpr double kWarningPeriod = 1;  // [s]
  ROS_WARN_STREAM_THROTTLE(kWarningPeriod, "A message on " << topic_ << " is ignored: " << complaint);
  ++statistics_.unreadable;
  complaint_ = complaint;
}

SourceStatistics TopicInput::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return statistics_;
}

std::string TopicInput::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!complaint_.empty()) return complaint_;
  if (statistics_.frames == 0)
    return "No image has arrived on " + topic_ + "; remap 'image' to the topic of the camera.";
  return "Images of " + topic_ + (info_ ? "." : " without camera_info: each is taken for the whole sensor.") +
         (depth_.bits > 8 ? " Their 16-bit values are taken as " + std::to_string(depth_.bits) + " bits." : "");
}

}  // namespace vibe::vision
