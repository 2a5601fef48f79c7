#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"

namespace vibe::vision {

/// What a motion says about one quantity of a calibration.
enum class Verdict {
  Holds,   ///< within its limit
  Wrong,   ///< beyond it, by more than three standard deviations from the calibration
  Unknown  ///< the motion does not show it
};

/// One quantity of a calibration, as a motion shows it.
struct CheckedQuantity {
  std::string name;  ///< "scale", "direction", "across", "perspective", "lens", "path", or the word of a Doubt
  Verdict verdict = Verdict::Unknown;  ///< what came of it
  double value = 0;                    ///< against the calibration [SI]; of a doubt the share of frames that have it
  double deviation = 0;                ///< standard deviation of the value [SI]; of the shutter of its row time [s]
  double limit = 0;                    ///< of the value, beyond which it is wrong [SI]
  std::string text;                    ///< value and deviation in words, and the remedy if it does not hold
};

/// What a motion says about one instrument.
struct CheckedInstrument {
  std::string name;                         ///< as configured
  std::uint64_t frames = 0, tracked = 0;    ///< looked at, seen
  double from = 0, to = 0;                  ///< slides between which it moved [m]
  std::vector<CheckedQuantity> quantities;  ///< geometry first, then doubts
};

/// Tells from pictures of a free motion whether a calibration still holds. Pictures along the way are measured each by
/// itself, with wide gates and without what earlier ones taught: size and place across the axis against the place along
/// it show scale, direction, perspective and lens. The doubts of a tracker that follows all frames show the rest.
///
/// Without known slides nobody can tell where slide 0 is, and not whether the print has another size or the axis
/// another scale.
class CalibrationCheck {
 public:
  explicit CalibrationCheck(const VisionConfig& config);  ///< with calibrated axes. @throws Error as Tracker
  ~CalibrationCheck();
  CalibrationCheck(const CalibrationCheck&) = delete;
  CalibrationCheck& operator=(const CalibrationCheck&) = delete;

  void add(const Frame& frame);                   ///< in the order of their stamps
  std::vector<CheckedInstrument> result() const;  ///< of the frames so far, in the order of the configuration

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
