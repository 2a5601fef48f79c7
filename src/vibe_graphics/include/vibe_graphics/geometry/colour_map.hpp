#pragma once
#include <array>
#include <string>
#include <vector>

#include "vibe_graphics/geometry/coloured_shape.hpp"

namespace vibe::graphics {

/// Maps values to colours. The maps are those of matplotlib (van der Walt & Smith 2015; Nunez, Anderton & Renslow
/// 2018 for cividis; CC0): lightness grows evenly, so equal steps of the value look equally large and a greyscale print
/// keeps the order.
class ColourMap {
 public:
  static constexpr int kSteps = 256;  ///< colours of a map

  /// Viridis between 0 and 1.
  ColourMap();
  /// @param name  one of colourMapNames(); another: viridis
  ColourMap(const std::string& name, double min, double max);

  /// Values out of range get the colour of the nearer end, NaN that of the lower end. If the range is empty, every
  /// value gets the colour of the lower end.
  PackedColour at(double value) const { return steps_[static_cast<std::size_t>(index(value))]; }

  double min() const { return min_; }  ///< value of the first colour, in the unit of the values
  /// Value of the last colour; min() if the range is empty.
  double max() const { return min_ + (scale_ > 0 ? (kSteps - 1) / scale_ : 0); }
  /// All colours, from that of min() to that of max().
  const std::array<PackedColour, kSteps>& steps() const { return steps_; }

 private:
  int index(double value) const {
    const double place = (value - min_) * scale_ + 0.5;
    return place >= kSteps ? kSteps - 1 : place >= 1 ? static_cast<int>(place) : 0;
  }

  std::array<PackedColour, kSteps> steps_;
  double min_ = 0, scale_ = kSteps - 1;  // scale_ [steps per unit]
};

/// "viridis", "magma", "cividis".
const std::vector<std::string>& colourMapNames();

}  // namespace vibe::graphics
