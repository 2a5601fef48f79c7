#pragma once
#include <string>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// A unit in which a surface may be measured.
struct LengthUnit {
  std::string name;   ///< as scenes write it
  double metres = 1;  ///< per unit
};

/// Every unit of length that scenes know, each once.
const std::vector<LengthUnit>& lengthUnits();

/// Whether a surface with a length has the size of a stomach.
struct SizeEstimate {
  LengthUnit unit;
  double confidence = 0;  ///< 0 to 1: the least of the marks
  std::string doubt;      ///< what lowers it: "it holds 45 L, and stomachs hold 0.1 to 3 L"
};

/// Guesses the unit of a surface: that with the highest mark, and among equals the one with the volume nearest to
/// 0.7 L. The marks of a unit are 1 where stomachs are and 0 far outside, and fall with the logarithm between:
///   volume  1 from 0.1 L (a sleeve: 0.09 to 0.22 L, Yehoshua 2008, Obes Surg 18:1083) to 3 L (capacity), 0 below 0.03
///           and above 6 L
///   wall    its mass, area times thickness, 1 from 50 to 450 g (0.15 kg, ICRP 89, 2002), 0 below 17 and above 1350 g
/// If another unit has a mark of 0.6 or more, too, the mark of the guess is at most a half.
/// @param surface    closed, oriented outwards, in its own unit
/// @param thickness  of the wall that the scene gives it [m]
SizeEstimate estimateUnit(const SurfaceMesh& surface, double thickness);

/// Lowers the confidence by the mark of the length of the axis [m]: 1 from 0.12 to 0.5 m (0.18 to 0.32 m in MRI and
/// textbooks, longer for a J-shaped stomach), 0 below 0.06 and above 0.9 m.
void addLengthMark(double length, SizeEstimate& estimate);

}  // namespace vibe
