#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "camera/pixels.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// What every source tells of itself, from any thread.
class ReportingSource : public FrameSource {
 public:
  explicit ReportingSource(std::string status) : status_(std::move(status)) {}
  SourceStatistics statistics() const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return statistics_;
  }
  std::string status() const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_;
  }

 protected:
  void say(const std::string& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = status;
  }
  void count(std::uint64_t SourceStatistics::*what, std::uint64_t by = 1) {
    const std::lock_guard<std::mutex> lock(mutex_);
    statistics_.*what += by;
  }

 private:
  mutable std::mutex mutex_;  // of what follows
  SourceStatistics statistics_;
  std::string status_;
};

// The kinds of openSource().

/// A GigE Vision or USB3 Vision camera. Stamps: the camera's own of each frame, mapped by StampClock. Frames of Mono8
/// are not copied: consumers share the buffers of the stream, and frames are copied only while many are held.
std::unique_ptr<FrameSource> openAravis(const std::string& name, const SourceOptions& options);

/// A V4L2 camera through OpenCV. Stamps: the kernel's of each buffer, from CAP_PROP_POS_MSEC.
std::unique_ptr<FrameSource> openV4l2(const std::string& device, const SourceOptions& options);

/// Recordings. Stamps are those of the table beside them. Without one, frame k is at k / rate; if the recording is
/// paced, this counts from the time at which it was first read, as if a camera took it now.
/// @throws Error if there is no recording, or the table does not fit it
std::unique_ptr<FrameSource> openVideo(const std::string& file, const SourceOptions& options);
std::unique_ptr<FrameSource> openImages(const std::string& pattern, const SourceOptions& options);

/// What keeps a file from being used as a V4L2 camera, with the remedy; empty if nothing does.
std::string v4l2Obstacle(const std::string& device);
/// Unix time of a kernel stamp (CLOCK_MONOTONIC) [s].
double unixFromMonotonic(double monotonic);
/// What a picture of the V4L2 driver holds, from its FOURCC; nothing readable: 0.
PixelFormat v4l2Format(int fourcc);

}  // namespace vibe::vision
