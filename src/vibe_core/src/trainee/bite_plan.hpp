#pragma once
#include <Eigen/Geometry>
#include <limits>

#include "trainee/operator.hpp"

namespace vibe {

/// How to take a bite: where the helix is to hold the wall and how the device is to lie, so that the needle passes
/// through the target once the wall has been drawn in.
struct BitePlan {
  WallPoint held;      ///< by the helix
  Hand::Joints joints;  ///< with the helix on the wall
  double miss = 0;     ///< of the needle from the target along the wall, as imagined [m]
  double depth = 0;    ///< of the needle, as imagined [m]
  double cost = std::numeric_limits<double>::infinity();
};

/// @param target  of the needle
/// @param error   what the needle missed beyond what had been imagined, in earlier tries: distal, anterior [m]
/// The device is turned around its axis to where the needle goes deepest with little motion.
BitePlan planBite(const WallPoint& target, const Eigen::Vector2d& error, Operator& me);

/// The same, with the device lying as it does now.
BitePlan planBiteFromHere(const WallPoint& target, const Eigen::Vector2d& error, Operator& me);

}  // namespace vibe
