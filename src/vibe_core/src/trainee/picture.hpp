#pragma once
#include "trainee/operator.hpp"

namespace vibe {

/// How a place lies in the endoscope's picture.
struct View {
  double distance = 0;  ///< of the tip from the place [m]
  double angle = 0;     ///< from the middle of the picture [rad]
};

View viewOf(const Eigen::Vector3d& place, const Observation& seen);

/// The joints that bring a place best into the middle of the picture: straight before the wall where the scope can,
/// else obliquely.
/// @param outward   of the wall at the place
/// @param distance  of the tip from the place [m]
TraineeHand::Joints bestView(const Eigen::Vector3d& place, const Eigen::Vector3d& outward, double distance,
                             Operator& me);

}  // namespace vibe
