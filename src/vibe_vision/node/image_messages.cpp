#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <cstring>
#include <opencv2/imgcodecs.hpp>

#include "vibe_core/program/error.hpp"
#include "vision_messages.hpp"

namespace vibe::vision {
namespace {

namespace encodings = sensor_msgs::image_encodings;

[[noreturn]] void fail(const std::string& problem, const std::string& remedy) {
  throw Error("An image " + problem + "; " + remedy + ".");
}

/// Refuses what would be read beyond its end or in the wrong place.
void checkImage(const sensor_msgs::Image& image, const sensor_msgs::CameraInfo& info) {
  if (image.header.stamp.isZero()) fail("has stamp 0", "the camera must stamp its images with the time of exposure");
  if (image.width == 0 || image.height == 0) fail("is empty", "check the camera");
  const std::size_t needed = static_cast<std::size_t>(image.step) * image.height;
  if (image.data.size() < needed || image.step < image.width) {
    fail("of " + sizeText(static_cast<int>(image.width), static_cast<int>(image.height)) + " px has only " +
             std::to_string(image.data.size()) + " bytes, in rows of " + std::to_string(image.step),
         "check the program that publishes it");
  }
  if (info.binning_x > 1 || info.binning_y > 1) fail("is binned", "switch binning off in the camera");
  const sensor_msgs::RegionOfInterest& roi = info.roi;
  if (roi.width != 0 && (roi.width != image.width || roi.height != image.height)) {
    fail("has " + sizeText(static_cast<int>(image.width), static_cast<int>(image.height)) +
             " px, but its camera_info has a region of interest of " +
             sizeText(static_cast<int>(roi.width), static_cast<int>(roi.height)) + " px",
         "both must come from the same program");
  }
}

/// The upper 8 of the bits that the camera uses.
cv::Mat upperBits(const sensor_msgs::ImageConstPtr& image, SampleDepth& depth) {
  const cv::Mat wide = cv_bridge::toCvShare(image)->image;
  double highest = 0;
  cv::minMaxLoc(wide, nullptr, &highest);
  depth.bits = std::max(depth.bits, 10);
  while (highest >= 1 << depth.bits) depth.bits += 2;
  cv::Mat grey(wide.size(), CV_8U);
  const int shift = depth.bits - 8;
  for (int y = 0; y < wide.rows; ++y)
    std::transform(wide.ptr<std::uint16_t>(y), wide.ptr<std::uint16_t>(y) + wide.cols, grey.ptr(y),
                   [shift](std::uint16_t v) { return static_cast<std::uint8_t>(v >> shift); });
  return grey;
}

/// Pixels of the image as grey values, shared if they are.
void setPixels(const sensor_msgs::ImageConstPtr& image, Frame& frame, SampleDepth& depth) {
  if (image->encoding == encodings::MONO8 || image->encoding == encodings::TYPE_8UC1) {
    frame.image = {image->data.data(), static_cast<int>(image->width), static_cast<int>(image->height),
                   static_cast<int>(image->step)};
    frame.owner = std::shared_ptr<const void>(image.get(), [image](const void*) {});
    return;
  }
  try {
    const bool wide = image->encoding == encodings::MONO16 || image->encoding == encodings::TYPE_16UC1;
    const auto grey =
        std::make_shared<cv::Mat>(wide ? upperBits(image, depth) : cv_bridge::toCvCopy(image, encodings::MONO8)->image);
    frame.image = {grey->data, grey->cols, grey->rows, static_cast<int>(grey->step)};
    frame.owner = grey;
  } catch (const std::exception&) {
    fail("has the encoding '" + image->encoding + "', which cannot be converted to grey", "set the camera to mono8");
  }
}

}  // namespace

sensor_msgs::CameraInfo makeCameraInfo(const CameraModel& camera, const Frame& frame, const std::string& frame_id) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = toStamp(frame.stamp);
  info.header.frame_id = frame_id;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(camera.distortion.begin(), camera.distortion.end());
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  const bool full = frame.image.width == camera.width && frame.image.height == camera.height;
  if (full) return info;  // all fields of the region are 0: the whole image
  info.roi.x_offset = static_cast<std::uint32_t>(std::max(0, frame.offset_x));
  info.roi.y_offset = static_cast<std::uint32_t>(std::max(0, frame.offset_y));
  info.roi.width = static_cast<std::uint32_t>(frame.image.width);
  info.roi.height = static_cast<std::uint32_t>(frame.image.height);
  return info;
}

sensor_msgs::ImagePtr makeImage(const Frame& frame, const std::string& frame_id) {
  sensor_msgs::ImagePtr image(new sensor_msgs::Image);
  image->header.stamp = toStamp(frame.stamp);
  image->header.frame_id = frame_id;
  image->encoding = encodings::MONO8;
  image->width = static_cast<std::uint32_t>(frame.image.width);
  image->height = static_cast<std::uint32_t>(frame.image.height);
  image->step = image->width;
  image->data.resize(static_cast<std::size_t>(image->step) * image->height);
  for (int y = 0; y < frame.image.height; ++y)
    std::memcpy(&image->data[static_cast<std::size_t>(y) * image->step], frame.image.row(y), image->width);
  return image;
}

sensor_msgs::ImagePtr makeImage(const sensor_msgs::CompressedImage& message) {
  cv::Mat grey;
  try {
    if (!message.data.empty()) grey = cv::imdecode(message.data, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    grey.release();
  }
  if (grey.empty())
    fail("in the format '" + message.format + "' cannot be decoded", "publish JPEG or PNG, or raw images");
  return cv_bridge::CvImage(message.header, encodings::MONO8, grey).toImageMsg();
}

Frame makeFrame(const sensor_msgs::ImageConstPtr& image, const sensor_msgs::CameraInfo& info, double exposure,
                bool start_stamped, SampleDepth& depth) {
  checkImage(*image, info);
  Frame frame;
  setPixels(image, frame, depth);
  const bool known = info.width != 0 && info.height != 0;
  frame.offset_x = static_cast<int>(info.roi.x_offset);
  frame.offset_y = static_cast<int>(info.roi.y_offset);
  frame.sensor_width = static_cast<int>(known ? info.width : image->width);
  frame.sensor_height = static_cast<int>(known ? info.height : image->height);
  frame.sequence = image->header.seq;
  frame.exposure = exposure;
  frame.stamp = image->header.stamp.toSec() + (start_stamped ? exposure / 2 : 0);
  return frame;
}

}  // namespace vibe::vision
