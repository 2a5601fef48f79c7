#pragma once
#include <memory>
#include <mutex>
#include <thread>

#include "camera/aravis_camera.hpp"
#include "camera/frame_timing.hpp"
#include "camera/host_time.hpp"
#include "camera/pixels.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// A GigE Vision or USB3 Vision camera. Stamps: the camera's own of each frame, mapped by StampClock. Frames of Mono8
/// are not copied: consumers share the buffers of the stream, and frames are copied only while many are held.
class AravisSource : public FrameSource {
 public:
  AravisSource(const std::string& name, const SourceOptions& options);
  ~AravisSource() override;
  ReadResult read(Frame& frame, double timeout) override;
  SourceStatistics statistics() const override;
  std::string status() const override;

 private:
  std::string name_;
  SourceOptions options_;
  std::unique_ptr<AravisCamera> camera_;
  std::thread burial_;  // takes apart the last camera that went
  RetryTimer retry_;
  StampClock clock_;
  SequenceCounter sequence_;
  PixelPool pool_;
  double last_sign_ = 0;           // steady time of the last buffer
  std::uint64_t thrown_away_ = 0;  // buffers since the last complete one
  bool has_connected_ = false;
  bool is_faulty_ = false;  // the status tells of frames that were thrown away
  double last_fault_ = 0;

  mutable std::mutex mutex_;  // of what follows
  SourceStatistics statistics_;
  std::string status_;

  ReadResult connect(double timeout);
  ReadResult disconnect(const std::string& reason);
  bool accept(ArvBuffer* buffer, Frame& frame);
  std::string obstacle(ArvBuffer* buffer, int& width, int& height) const;
  void number(ArvBuffer* buffer, Frame& frame);
  void stamp(ArvBuffer* buffer, Frame& frame);
  void keepPixels(ArvBuffer* buffer, Frame& frame, int width, int height);
  void throwAway(ArvBuffer* buffer, std::uint64_t SourceStatistics::*count, const std::string& reason);
  void say(const std::string& text);
  std::string goodStatus() const;
};

}  // namespace vibe::vision
