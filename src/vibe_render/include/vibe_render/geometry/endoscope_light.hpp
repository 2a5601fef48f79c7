#pragma once

#include <array>

#include <Eigen/Core>

namespace vibe::render {

/// The end of a bundle of fibres beside the lens.
struct LightGuide {
  double right, up;     ///< of the lens, as the picture shows right and up [m]
  double strength = 1;  ///< of its light [1]
};

/// The light of an endoscope. The defaults are that of the live view.
struct EndoscopeLight {
  std::array<LightGuide, 2> guides{{{0.0035, 0.0012}, {-0.0035, 0.0012}}};  ///< a tip of 9.8 mm holds them
  double sideward = 0.3;                     ///< light of a guide at right angles, as a part of its light ahead
  double temperature = 5800;                 ///< of the colour of the light [K]
  static constexpr double kBalanced = 5800;  ///< for which the processor shows white as white [K]
};

/// Red, green and blue of a white wall in light of this temperature (Planck 1901), when white is balanced for
/// EndoscopeLight::kBalanced. Green is 1.
/// @param temperature  above 1,000 K
Eigen::Vector3d lightColour(double temperature);

/// What the guide shines at right angles (x), and how much more ahead (y): its light in the direction z is x + y z. The
/// guides of the default have 0.15 and 0.35.
Eigen::Vector2d coneOf(const EndoscopeLight& light, const LightGuide& guide);

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

}  // namespace vibe::render
