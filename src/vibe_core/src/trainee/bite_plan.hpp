#pragma once
#include <Eigen/Geometry>
#include <limits>

#include "trainee/operator.hpp"

namespace vibe {

/// How to take a bite: where the helix is to hold the wall and how the device is to lie, so that the needle passes
/// through the target once the wall has been drawn in.
struct BitePlan {
  WallPoint held;              ///< by the helix
  TraineeHand::Joints joints;  ///< with the helix on the wall
  double drawn = 0;            ///< helix_advance to which the wall is to be drawn [m]
  double miss = 0;             ///< of the needle from the target along the wall, as imagined [m]
  double depth = 0;            ///< of the needle, as imagined [m]
  double cost = std::numeric_limits<double>::infinity();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< orientation of scope_tip with these joints
  double in_the_way = 0;  ///< wall or folds that lie where the scope would, beside the target [m^3]
};

/// With foresight, the place follows from the wall imagined as drawn in, corrected by the last surprise, and the device
/// is turned around its axis to where the needle goes deep with little motion. Without, the needle is taken to pass
/// where it is beside the helix now, and the device stays as it is turned.
/// @param target  of the needle
BitePlan planBite(const WallPoint& target, Operator& me);

/// The same, with the device lying as it does now.
BitePlan planBiteFromHere(const WallPoint& target, Operator& me);

}  // namespace vibe
