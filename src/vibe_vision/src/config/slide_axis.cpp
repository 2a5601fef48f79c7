#include "vibe_vision/config/slide_axis.hpp"

namespace vibe::vision {

double alongOf(const SlideAxis& axis, double slide) {
  return axis.pixels_per_metre * slide / (1 + axis.perspective * slide);
}

double slideOf(const SlideAxis& axis, double along) {
  return along / (axis.pixels_per_metre - axis.perspective * along);
}

double pixelsPerMetre(const SlideAxis& axis, double slide) {
  const double w = 1 + axis.perspective * slide;
  return axis.pixels_per_metre / (w * w);
}

}  // namespace vibe::vision
