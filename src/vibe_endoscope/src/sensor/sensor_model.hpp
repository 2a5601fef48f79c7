#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_graphics/geometry/endoscope_optics.hpp"

namespace vibe::endoscope {

/// What the optics and the sensor of a real camera do to an image. The defaults do nothing. All are design choices
/// within the range of endoscopes; ranges are those of the parameters of endoscope_camera.
struct SensorStyle {
  double exposure = 1;                 ///< factor on the light, 0.05 to 20
  double red_gain = 1, blue_gain = 1;  ///< factors on red and blue, 0.5 to 2: colour balance
  double vignetting = 0;               ///< part of the light that is lost at the rim of the circle, 0 to 1
  double blur = 0;                     ///< standard deviation of the point spread, 0 to 10 [px]
  /// Radial distortion, -0.2 to 0.2: the coefficient k1 of the model that camera_info names. Equidistant lens (Kannala
  /// and Brandt 2006): r = f (theta + k1 theta^3); rectilinear (Brown 1966): r = f (t + k1 t^3), t = tan theta.
  double distortion = 0;
  double full_well = 0;    ///< electrons of a white pixel, for shot noise; 0: none; up to 1e6
  double read_noise = 0;   ///< standard deviation, as part of white, 0 to 0.5
  std::uint32_t seed = 0;  ///< of the noise

  bool isPlain() const;  ///< whether images stay as they are
};

/// Why this style is impossible for this camera, as a sentence without capital and period; empty: it is possible. The
/// distortion must not fold the image over.
std::string problemOf(const SensorStyle& style, const graphics::RoundCamera& camera);

/// Where the distorted lens shows the point that the ideal lens shows at `pixel`.
Eigen::Vector2d distorted(const SensorStyle& style, const graphics::RoundCamera& camera, const Eigen::Vector2d& pixel);
/// The inverse.
Eigen::Vector2d undistorted(const SensorStyle& style, const graphics::RoundCamera& camera,
                            const Eigen::Vector2d& pixel);

/// Makes images of a real sensor from ideal ones. Light is computed in linear values of sRGB (IEC 61966-2-1), in this
/// order: distortion, blur, vignetting, exposure and gains, shot noise and read noise, rounding to 8 bits. Noise is
/// Gaussian with the variance light / full_well + read_noise^2, which is that of photons for more than some ten of them
/// (EMVA 1288).
class SensorModel {
 public:
  /// @param style  possible for the camera
  SensorModel(const SensorStyle& style, const graphics::RoundCamera& camera);

  /// Changes an image in place. The noise depends on seed, number, place and colour alone.
  /// @param pixels  red, green, blue of the rows from the top
  /// @param number  of the image, so that noise differs from image to image
  void expose(std::vector<std::uint8_t>& pixels, std::uint64_t number);

 private:
  void linearise(const std::vector<std::uint8_t>& pixels);
  void distort();
  void blur();
  void blurLine(std::size_t first, std::size_t step, int count);
  void develop(std::vector<std::uint8_t>& pixels, std::uint64_t number) const;

  SensorStyle style_;
  graphics::RoundCamera camera_;
  std::vector<float> kernel_;  // of the blur, from the middle
  std::vector<float> source_;  // x y of the ideal image per pixel, for the distortion
  std::vector<float> share_;   // of the light per pixel: vignetting and exposure; 0 outside of the circle
  std::vector<float> light_, scratch_;
};

}  // namespace vibe::endoscope
