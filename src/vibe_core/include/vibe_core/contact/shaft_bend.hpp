#pragma once

#include <array>
#include <vector>

#include "vibe_core/state/tool_displacement.hpp"

namespace vibe {

/// Most joints of a shaft in one direction.
constexpr int kMaxShaftStations = 16;

/// The bent shaft of a tool as a chain of joints: the part inside the lumen is a beam, clamped where it enters, whose
/// curvature is linear along it (exact for a force and a moment at its end, Euler and Bernoulli). Each joint takes the
/// curvature around it with the weight of a hat function, which leaves the rotation and the deflection of the beam's
/// end exact for small angles, wherever the joints are.
class ShaftBend {
 public:
  /// How the angle of a joint follows from the two amplitudes of its direction, and how these shares change with the
  /// free length.
  struct Share {
    double mean = 0, change = 0;            ///< [m]
    double mean_rate = 0, change_rate = 0;  ///< per metre of free length [1]
  };

  /// @param stations      distance of each joint from the end of the shaft, ascending [m], kMaxShaftStations at most
  /// @param free_length   of the shaft between entry and end; 0 or less: nothing bends [m]
  /// @param displacement  of the tool
  ShaftBend(const std::vector<double>& stations, double free_length, const ToolDisplacement& displacement);

  const Share& share(int station) const { return shares_[static_cast<std::size_t>(station)]; }
  /// Angle of a joint. @param direction  0: up, 1: left [rad]
  double angle(int station, int direction) const;
  /// Its change with the free length at constant amplitudes [rad/m]
  double angleRate(int station, int direction) const;

 private:
  std::array<Share, kMaxShaftStations> shares_{};
  ToolDisplacement displacement_;
};

}  // namespace vibe
