#pragma once

#include <mutex>
#include <string>

#include <opencv2/videoio.hpp>

#include "camera/frame_timing.hpp"
#include "camera/host_time.hpp"
#include "camera/pixels.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// What keeps a file from being used as a V4L2 camera, with the remedy; empty if nothing does.
std::string v4l2Obstacle(const std::string& device);

/// Unix time of a kernel stamp (CLOCK_MONOTONIC) [s].
double unixFromMonotonic(double monotonic);

/// What a picture of the V4L2 driver holds, from its FOURCC; nothing readable: 0.
PixelFormat v4l2Format(int fourcc);

/// A V4L2 camera through OpenCV. Stamps: the kernel's of each buffer, from CAP_PROP_POS_MSEC.
class V4l2Source : public FrameSource {
 public:
  V4l2Source(const std::string& device, const SourceOptions& options);
  ReadResult read(Frame& frame, double timeout) override;
  SourceStatistics statistics() const override;
  std::string status() const override;

 private:
  std::string device_;
  SourceOptions options_;
  cv::VideoCapture capture_;
  PixelFormat format_{};
  bool has_connected_ = false;
  RetryTimer retry_;
  PixelPool pool_;
  IntervalGaps gaps_{1};
  double exposure_ = 0;  // that the driver tells [s]
  std::string good_status_;
  std::uint64_t sequence_ = 0;

  mutable std::mutex mutex_;  // of what follows
  SourceStatistics statistics_;
  std::string status_;

  ReadResult connect(double timeout);
  void configure();
  bool convert(const cv::Mat& picture, Frame& frame);
  bool stamp(Frame& frame);
  void throwAway(const std::string& reason);
  void say(const std::string& text);
};

}  // namespace vibe::vision
