#pragma once
#include <cstddef>

#include "track/sleeve_pattern.hpp"

namespace vibe::vision {

/// A pose, ready for use.
struct SleevePattern::View {
  float along, lateral, rotation;
  float tilt_cosine, tilt_sine, inverse_scale;
  float slant_cosine, slant_sine;
  float bend;         ///< of the line of sight per pixel: 1 / focal length; also 1 / distance to the camera [1/px]
  float principal_x;  ///< of the camera, along the tilted marker from its centre [px]
  float across;       ///< slope of the line of sight to the centre, across the tilted marker
  float turn;         ///< of the direction to the camera around the rod against the normal of the image [rad]
  float half_motion;  ///< in pixels of the print, where the camera looks at it at a right angle
  float variance;     ///< of optics and pixel in pixels of the print, less what a lengthened motion has
  float by_blur;      ///< relative change of `variance` with the blur [1/px]
};

/// Some pixels. Lengths are in pixels of the print.
struct SleevePattern::Part {
  static constexpr std::size_t kSize = 64;
  std::size_t size = kSize;
  alignas(64) float x[kSize], v[kSize];  ///< along and across in the picture
  alignas(64) float u[kSize], w[kSize];  ///< along the print, from its centre and from a black part's centre
  alignas(64) float sine[kSize], cosine[kSize], phi[kSize];    ///< around the rod
  alignas(64) float stretch[kSize], lean[kSize], turn[kSize];  ///< change of u along and across, of phi pitch / 2 pi
  alignas(64) float by_slant[kSize];                           ///< change of u
  alignas(64) float half_motion[kSize], stripe_half_motion[kSize];
  alignas(64) float bar_variance[kSize], stripe_variance[kSize], cut_variance[kSize];
  alignas(64) float inside[kSize], outside[kSize];  ///< of the helix, and of its ends: 1 or 0
  alignas(64) float bars[kSize], bars_slope[kSize], bars_bend[kSize];
  alignas(64) float stripe[kSize], stripe_slope[kSize], stripe_bend[kSize];
  alignas(64) int tells[kSize];  ///< 1: the pixel is near an edge
  alignas(64) float value[kSize], by_u[kSize], by_w[kSize], by_blur[kSize];
};

/// Blackness and its derivatives: by a shift of all, by a shift of the stripe alone, and by the relative change of the
/// blur's variance.
struct SleevePattern::Blackness {
  float value = 0, by_u = 0, by_w = 0, by_blur = 0;
};

}  // namespace vibe::vision
