#include "vibe_graphics/geometry/colour_map.hpp"

namespace vibe::graphics {
namespace {

constexpr int kAnchors = 33;  // straight between: off by at most 2 of 255 levels, cividis 6 at its dark end
using Anchors = std::array<std::array<std::uint8_t, 3>, kAnchors>;

// matplotlib's tables at 33 even places.
// clang-format off
constexpr Anchors kViridis{{
    {68, 1, 84}, {71, 13, 96}, {72, 24, 106}, {72, 35, 116}, {71, 45, 123}, {69, 54, 129},
    {66, 64, 134}, {63, 73, 137}, {59, 82, 139}, {55, 90, 141}, {51, 99, 141}, {47, 106, 142},
    {44, 114, 142}, {41, 122, 142}, {38, 129, 142}, {35, 137, 142}, {33, 144, 140}, {31, 152, 139},
    {31, 159, 136}, {33, 166, 133}, {40, 174, 128}, {49, 181, 123}, {62, 188, 116}, {76, 194, 108},
    {93, 201, 99}, {110, 206, 88}, {130, 211, 76}, {150, 216, 63}, {171, 220, 50}, {192, 223, 36},
    {213, 226, 26}, {234, 229, 26}, {253, 231, 37}
}};
// clang-format on

// clang-format off
constexpr Anchors kMagma{{
    {0, 0, 4}, {3, 3, 17}, {10, 8, 34}, {19, 13, 51}, {29, 17, 70}, {40, 17, 90},
    {54, 16, 106}, {67, 15, 118}, {80, 18, 124}, {93, 23, 127}, {105, 28, 129}, {118, 33, 129},
    {130, 38, 129}, {143, 42, 129}, {156, 46, 127}, {169, 50, 125}, {182, 55, 121}, {195, 59, 117},
    {207, 65, 112}, {219, 72, 106}, {230, 81, 99}, {238, 92, 94}, {245, 105, 92}, {249, 120, 93},
    {251, 135, 97}, {253, 150, 104}, {254, 165, 113}, {254, 180, 123}, {254, 195, 135}, {254, 209, 148},
    {253, 224, 162}, {252, 238, 176}, {252, 253, 191}
}};
// clang-format on

// clang-format off
constexpr Anchors kCividis{{
    {0, 34, 78}, {0, 40, 91}, {0, 46, 106}, {4, 51, 113}, {26, 56, 111}, {39, 62, 110},
    {50, 67, 109}, {59, 73, 108}, {67, 78, 108}, {75, 84, 108}, {82, 89, 109}, {90, 95, 110},
    {97, 101, 111}, {104, 106, 113}, {111, 112, 115}, {117, 118, 118}, {124, 123, 120}, {132, 129, 121},
    {139, 135, 120}, {147, 141, 120}, {155, 147, 118}, {163, 154, 117}, {171, 160, 114}, {179, 166, 112},
    {187, 173, 108}, {195, 180, 105}, {204, 186, 100}, {212, 193, 95}, {221, 201, 88}, {230, 208, 81},
    {239, 215, 72}, {248, 223, 60}, {254, 232, 56}
}};
// clang-format on

const Anchors& anchorsOf(const std::string& name) {
  if (name == "magma") return kMagma;
  if (name == "cividis") return kCividis;
  return kViridis;
}

std::array<PackedColour, ColourMap::kSteps> stepsOf(const Anchors& anchors) {
  std::array<PackedColour, ColourMap::kSteps> steps;
  for (int s = 0; s < ColourMap::kSteps; ++s) {
    const double place = static_cast<double>(s) * (kAnchors - 1) / (ColourMap::kSteps - 1);
    const int lower = s == ColourMap::kSteps - 1 ? kAnchors - 2 : static_cast<int>(place);
    const double part = place - lower;
    double channel[3];
    for (std::size_t k = 0; k < 3; ++k)
      channel[k] = ((1 - part) * anchors[static_cast<std::size_t>(lower)][k] +
                    part * anchors[static_cast<std::size_t>(lower) + 1][k]) /
                   255;
    steps[static_cast<std::size_t>(s)] = packed(channel[0], channel[1], channel[2]);
  }
  return steps;
}

}  // namespace

ColourMap::ColourMap() : ColourMap("viridis", 0, 1) {}

ColourMap::ColourMap(const std::string& name, double min, double max)
    : steps_(stepsOf(anchorsOf(name))), min_(min), scale_(max > min ? (kSteps - 1) / (max - min) : 0) {}

const std::vector<std::string>& colourMapNames() {
  static const std::vector<std::string> names{"viridis", "magma", "cividis"};
  return names;
}

}  // namespace vibe::graphics
