#pragma once
#include <memory>
#include <string>

#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// Reads a source in a thread of its own and keeps the newest frame only: a slow consumer drops frames, it never lags,
/// and memory stays constant. One thread takes; the other functions may be called from any.
class Capture {
 public:
  explicit Capture(std::unique_ptr<FrameSource> source);
  ~Capture();  ///< stops the thread; waits for a read or an opening of the camera under way
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  /// The newest frame that was not taken yet. Gone is told after the timeout, End after the last frame was taken.
  /// @param timeout [s]
  ReadResult take(Frame& frame, double timeout);
  std::uint64_t dropped() const;  ///< overwritten before they were taken
  SourceStatistics statistics() const;
  std::string status() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
