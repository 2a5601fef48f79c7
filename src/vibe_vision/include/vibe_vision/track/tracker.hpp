#pragma once
#include <memory>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"
#include "vibe_vision/track/measurement.hpp"

namespace vibe::vision {

/// Follows all instruments of a rig from frame to frame. Each frame: predict, fit the marker's model to the pixels
/// around the prediction; if that fails a gate, search the axis in the same frame, fit and gate again; else report it
/// as lost. The cost of a tracked frame does not depend on the size of the sensor. Deterministic: the same frames give
/// the same bits. Frames of another size than the camera model's are WrongImage.
///
/// Not thread-safe; use one per thread.
class Tracker {
 public:
  /// @throws Error if the configuration cannot be tracked: see checkMarker()
  explicit Tracker(const VisionConfig& config);
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// @return valid until the next call
  const Measurements& track(const Frame& frame);
  /// Forgets where the instruments are; turns of the rotation are kept.
  void reset();
  const VisionConfig& config() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
