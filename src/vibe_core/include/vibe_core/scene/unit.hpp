#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vibe {

/// Exponents of the base dimensions. Angle is one of them, so that a length is never mistaken for an angle.
struct Dimension {
  int length = 0;  ///< exponent of the metre
  int mass = 0;    ///< exponent of the kilogram
  int time = 0;    ///< exponent of the second
  int angle = 0;   ///< exponent of the radian
  int pixel = 0;   ///< exponent of the pixel of an image
  int grey = 0;    ///< exponent of the grey value of an image
};
bool operator==(const Dimension& a, const Dimension& b);
inline bool operator!=(const Dimension& a, const Dimension& b) {
  return !(a == b);
}

/// A unit of measure: SI value = factor * value in this unit.
struct Unit {
  double factor = 1;    ///< SI value of one of it, above 0
  Dimension dimension;  ///< what it measures
};

/// Reads a unit such as "mm", "mmHg", "L/min", "g/cm^3", "1/s", "N*s/m", "N m^2" or "%". Empty for an unknown one.
/// Conversion factors: BIPM, The International System of Units, 9th edition 2019; mmHg as 133.322387415 Pa.
std::optional<Unit> parseUnit(const std::string& text);

/// Symbols of lengths with their metres, as parseUnit() knows them; some mean the same.
std::vector<std::pair<std::string, double>> knownLengths();

/// A value in SI, or what is wrong with the text (the end of a sentence for an error message, with a remedy).
struct Quantity {
  double value = 0;     ///< in the SI unit that was asked for
  std::string problem;  ///< empty if the value is valid
};

/// Reads "10 mmHg", "2.3 mm", "30 1/s" or a plain number, which is taken in `si_unit`.
/// @param si_unit  what the caller needs: "m", "Pa", "1" for a pure number ...; must itself be a known unit
Quantity parseQuantity(const std::string& text, const std::string& si_unit);

/// Reads a finite plain number, the whole text, independent of the locale.
Quantity parseNumber(const std::string& text);

/// "a pressure; write for example 1333 (Pa), 10 mmHg or 1.3 kPa": what a unit measures and how to write it.
std::string describeQuantity(const std::string& si_unit);

}  // namespace vibe
