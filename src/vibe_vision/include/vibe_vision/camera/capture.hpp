#pragma once
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

/// The newest frame that nobody has taken yet, between a thread that gives and one that takes: a slow consumer drops
/// frames, it never lags, and memory stays constant. All functions may be called from any thread.
class LatestFrame {
 public:
  /// Gives a frame; one that was not taken is overwritten, and counts as dropped.
  void put(Frame frame);
  /// No frame comes any more: take() does not wait for one.
  void close();
  /// @param timeout  [s]
  /// @return Frame, Timeout, or End after close() and the last frame
  ReadResult take(Frame& frame, double timeout);
  std::uint64_t dropped() const;  ///< overwritten before they were taken

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Frame frame_;
  bool is_fresh_ = false, is_closed_ = false;
  std::uint64_t dropped_ = 0;
};

/// Reads a source in a thread of its own and keeps the newest frame only: a slow consumer drops frames, it never lags,
/// and memory stays constant. One thread takes; the other functions may be called from any.
class Capture {
 public:
  /// Begins to read at once. @param source  its statistics() and status() may be called from any thread
  explicit Capture(std::unique_ptr<FrameSource> source);
  ~Capture();  ///< stops the thread; waits for a read or an opening of the camera under way
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  /// The newest frame that was not taken yet. Gone is told after the timeout, End after the last frame was taken.
  /// @param timeout [s]
  ReadResult take(Frame& frame, double timeout);
  std::uint64_t dropped() const;        ///< overwritten before they were taken
  SourceStatistics statistics() const;  ///< of the source
  std::string status() const;           ///< one line for people: that of the source, or why the thread has ended

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
