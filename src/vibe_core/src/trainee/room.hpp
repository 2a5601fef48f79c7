#pragma once
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "trainee/operator.hpp"

namespace vibe {

/// Less than this is no hindrance: a dent of half a millimetre under a fifth of a square centimetre; 0.04 mL press with
/// some 4 N on a stomach at 10 mmHg [m^3]
constexpr double kRoomy = 0.01e-6;

/// How much of the wall as it is seen now would lie in the tool, if nothing gave way: where it is not 0, the wall or a
/// fold stands in the way. The ends of the organ through which the tool passes do not count [m^3].
/// @param may_touch  particles of the wall to which the tip is to go: there only what leads to the tip counts; empty:
///                   none
double overlapWithWall(const Model& model, const std::vector<Eigen::Vector3d>& wall, const TraineeHand::Joints& joints,
                       const std::function<bool(int)>& may_touch = {});

}  // namespace vibe
