#pragma once

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/image/frame.hpp"

namespace vibe::vision {

/// Measures the noise of pictures: the second differences of neighbouring pixels in the smoothest quarter of small
/// tiles. What a picture shows bends slowly there, so that noise is what is left (Immerkaer, "Fast noise variance
/// estimation", Computer Vision and Image Understanding 64, 1996). The tiles are as many in every picture.
class NoiseMeter {
 public:
  explicit NoiseMeter(const PixelNoise& stated) : stated_(stated) {}

  /// Measures a picture, or leaves it out: every 16th is enough, and the first ones.
  void look(const ImageView& image);
  /// The stated noise, or more if pictures show more.
  PixelNoise noise() const;
  /// The stated noise is clearly too small.
  bool doubtsStated() const;

 private:
  double ratioOf(const ImageView& image, int left, int top) const;

  PixelNoise stated_;
  int frames_ = 0;
  double ratio_ = 0;  ///< of the variance to the stated one; 0: nothing was measured
};

}  // namespace vibe::vision
