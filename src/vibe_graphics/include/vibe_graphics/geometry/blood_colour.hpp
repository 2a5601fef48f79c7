#pragma once

#include <Eigen/Core>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"

namespace vibe::graphics {

/// How bleeding is drawn. The shape depends on the message, its time and the wall of that time alone.
struct BloodStyle {
  Eigen::Vector3d down{-1, 0, 0};  ///< direction of gravity, unit; default: patient in supine position
  double emphasis = 1;             ///< factor for the thickness of jets and drops
  double time = 0;                 ///< of the message; phase of the pulse of brisk bleeding [s]
};

/// Colour of blood and what it hides, 0 to 1.
struct BloodShade {
  double red, green, blue, alpha;  ///< of a display, not linear
};

/// Fresh in a jet or a thin layer, in a drop, in a deep pool, and clotted. Design choices: haemoglobin lets red light
/// pass some ten times farther than green (Bosschaart 2014, doi:10.1007/s10103-013-1446-7), so thin blood is bright and
/// thick blood dark.
constexpr BloodShade kBrightBlood{0.84, 0.03, 0.03, 0.97}, kDarkBlood{0.60, 0.012, 0.03, 0.95},
    kDeepBlood{0.42, 0.006, 0.014, 0.97}, kClottedBlood{0.24, 0.06, 0.04, 0.62};  ///< in a deep pool, and clotted

BloodShade mixed(const BloodShade& a, const BloodShade& b, double part);  ///< a with 0, b with 1, linear between
/// For a vertex buffer. @param alpha  factor of that of the shade, 0 to 1
PackedColour packedOf(const BloodShade& shade, double alpha = 1);

/// 0: fresh, as it bleeds. From 1/2 when it has stopped towards 1 with age: half of the rest in 45 s (design choice).
double brownOf(const Wound& wound);

/// Of a layer on the wall, by the law of Beer and Lambert.
/// @param depth  seen along the normal of the wall [m]
/// @param brown  0 to 1
BloodShade layerOf(double depth, double brown);

/// Pseudo-random value from -1 to 1 for the number of a wound, so that shapes differ.
double wobble(int number, int which);

}  // namespace vibe::graphics
