#pragma once
#include <Eigen/Core>

#include "input/input_sample.hpp"
#include "vibe_core/model/model.hpp"

namespace vibe::sim {

/// Where the joints of the scope are after `dt` with scope_tip moving at a velocity, as far as four joints can: the
/// linear velocity first, and of the angular one what it leaves. All joints are slowed by one factor so that none is
/// faster than its limit, and stop at their limits. Nothing that bends the scope counts. (Resolved rates with priority:
/// Whitney 1969, Nakamura 1987.)
/// @param joints  at the beginning [m], [rad]
/// @param twist   linear [m/s] and angular [rad/s] velocity in world
/// @param dt      [s]
/// @pre the model has a tool
JointArray afterTwist(const Model& model, const JointArray& joints, const Eigen::Matrix<double, 6, 1>& twist,
                      double dt);

}  // namespace vibe::sim
