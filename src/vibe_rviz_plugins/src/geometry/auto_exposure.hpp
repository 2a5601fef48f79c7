#pragma once

namespace vibe::rviz_plugins {

/// The exposure of a video processor: brings the mean level of the picture to a target, at a limited rate. A function
/// of the levels and stamps it has seen, so the same pictures are exposed in the same way again.
class AutoExposure {
 public:
  static constexpr double kTarget = 0.45;  ///< mean level of the picture, weighted to its centre; design choice [1]
  static constexpr double kRate = 4;       ///< fastest change [stops/s]; design choice: about 0.3 s for a usual change
  static constexpr double kGap = 0.5;      ///< after that long without a picture the exposure is found anew [s]
  static constexpr double kFixedGain = 1.6;                ///< without automatic exposure, and at first [1]
  static constexpr double kMinGain = 0.02, kMaxGain = 60;  ///< about 6 and 5 stops around; design choice [1]

  /// What the radiances of the next picture are to be multiplied with.
  double gain() const { return gain_; }

  /// Tells the mean level of a picture that was taken with gain().
  /// @param level  0 to 1, linear between black and white of the screen
  /// @param time   of the picture [s]
  void see(double level, double time);

  /// Whether the last picture was the first one, or the first after a gap or after time was set back, and its level was
  /// far from the target: it should be taken again with the new gain.
  bool isLost() const { return lost_; }

 private:
  double gain_ = kFixedGain;
  double time_ = 0;
  bool begun_ = false, lost_ = false;
  int tries_ = 0;  ///< of the picture of time_
};

}  // namespace vibe::rviz_plugins
