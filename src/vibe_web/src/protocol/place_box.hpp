#pragma once

#include <array>
#include <cstdint>

namespace vibe::web {

/// A box around points, in which a coordinate is lowest + step * place: 65,535 steps wide, so that half a step is the
/// largest error (2.5 micrometres in a box of 0.33 m).
struct PlaceBox {
  std::array<float, 3> lowest{}, step{};  ///< [m]

  /// @param point  returns x y z of a point by its number
  template <class Point>
  PlaceBox(std::size_t count, const Point& point) {
    for (std::size_t k = 0; k < 3 && count > 0; ++k) {
      float low = point(0)[k], high = low;
      for (std::size_t i = 1; i < count; ++i) {
        low = low < point(i)[k] ? low : point(i)[k];
        high = high > point(i)[k] ? high : point(i)[k];
      }
      lowest[k] = low;
      step[k] = (high - low) / kSteps;
    }
  }

  std::uint16_t place(float coordinate, std::size_t k) const {
    const float steps = step[k] > 0 ? (coordinate - lowest[k]) / step[k] + 0.5F : 0;
    return static_cast<std::uint16_t>(steps < 0 ? 0 : steps > kSteps ? kSteps : steps);
  }

  static constexpr float kSteps = 65535;
};

}  // namespace vibe::web
