#include "vibe_graphics/geometry/blood_colour.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::graphics {
namespace {

constexpr double kBrown = 45;      // [s]
constexpr double kHides = 0.1e-3;  // depth after which 1/e of what is below is seen [m]
constexpr double kDark = 2.5e-3;   // the same for the red light that makes it bright [m]

}  // namespace

BloodShade mixed(const BloodShade& a, const BloodShade& b, double part) {
  return {a.red + part * (b.red - a.red), a.green + part * (b.green - a.green), a.blue + part * (b.blue - a.blue),
          a.alpha + part * (b.alpha - a.alpha)};
}

PackedColour packedOf(const BloodShade& shade, double alpha) {
  return packed(shade.red, shade.green, shade.blue, shade.alpha * alpha);
}

double brownOf(const Wound& wound) {
  return wound.rate > 0 ? 0 : 0.5 + 0.5 * wound.age / (wound.age + kBrown);
}

BloodShade layerOf(double depth, double brown) {
  depth = std::max(depth, 0.0);
  BloodShade shade = mixed(kBrightBlood, kDeepBlood, 1 - std::exp(-depth / kDark));
  shade = mixed(shade, kClottedBlood, brown);
  shade.alpha *= 1 - std::exp(-depth / kHides);
  return shade;
}

double wobble(int number, int which) {
  const double value = std::sin(12.9898 * (number + 1) + 78.233 * (which + 1)) * 43758.5453;
  return 2 * (value - std::floor(value)) - 1;
}

}  // namespace vibe::graphics
