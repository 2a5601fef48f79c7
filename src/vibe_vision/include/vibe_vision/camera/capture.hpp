#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

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

/// Where somebody takes the newest frame. One thread takes; the other functions may be called from any.
class FrameInput {
 public:
  virtual ~FrameInput() = default;
  /// The newest frame that was not taken yet. Gone is told after the timeout, End after the last frame was taken.
  /// @param timeout [s]
  virtual ReadResult take(Frame& frame, double timeout) = 0;
  virtual std::uint64_t dropped() const = 0;        ///< frames that a newer one has replaced before they were taken
  virtual SourceStatistics statistics() const = 0;  ///< of the source
  virtual std::string status() const = 0;           ///< one line for people
};

/// Reads a source in a thread of its own and keeps the newest frame only: a slow consumer drops frames, it never lags,
/// and memory stays constant.
class Capture : public FrameInput {
 public:
  /// Begins to read at once. @param source  its statistics() and status() may be called from any thread
  explicit Capture(std::unique_ptr<FrameSource> source);
  ~Capture() override;  ///< stops the thread; waits for a read or an opening of the camera under way
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  ReadResult take(Frame& frame, double timeout) override;
  std::uint64_t dropped() const override { return latest_.dropped(); }
  SourceStatistics statistics() const override { return source_->statistics(); }
  std::string status() const override;  ///< that of the source, or why the thread has ended

 private:
  std::unique_ptr<FrameSource> source_;
  std::atomic<bool> shall_stop_{false};
  std::atomic<bool> is_gone_{false};  // at the last read
  LatestFrame latest_;
  mutable std::mutex mutex_;
  std::string failure_;
  std::thread thread_;

  void run();
};

}  // namespace vibe::vision
