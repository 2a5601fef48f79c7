#pragma once
#include <memory>
#include <string>

#include "vibe_vision/camera/capture.hpp"

namespace vibe::vision {

/// What the node gets frames from: a camera of its own or a topic. The newest frame wins.
class FrameInput {
 public:
  virtual ~FrameInput() = default;
  /// @param timeout  [s]
  virtual ReadResult take(Frame& frame, double timeout) = 0;
  virtual SourceStatistics statistics() const = 0;
  virtual std::uint64_t dropped() const = 0;  ///< frames that a newer one has replaced
  virtual std::string status() const = 0;     ///< one line for people
};

/// A camera or a recording that belongs to the node.
class CameraInput : public FrameInput {
 public:
  CameraInput(const std::string& address, const SourceOptions& options) : capture_(openSource(address, options)) {}
  ReadResult take(Frame& frame, double timeout) override { return capture_.take(frame, timeout); }
  SourceStatistics statistics() const override { return capture_.statistics(); }
  std::uint64_t dropped() const override { return capture_.dropped(); }
  std::string status() const override { return capture_.status(); }

 private:
  Capture capture_;
};

}  // namespace vibe::vision
