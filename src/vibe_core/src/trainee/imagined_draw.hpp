#pragma once
#include <optional>

#include "trainee/needle_view.hpp"

namespace vibe {

/// Distance at which the wall does not follow any more, far from folds; measured [m].
constexpr double kFollowsFree = 0.14;

/// A helix that holds the wall and draws it into the device, imagined before it does so.
struct ImaginedDraw {
  WallPoint held;                 ///< of the wall
  Eigen::Quaterniond turn;        ///< orientation of scope_tip, in world
  double from = 26e-3;            ///< helix_advance where it takes hold [m]
  double drawn = 3e-3;            ///< and at the end [m]
  double follows = kFollowsFree;  ///< see kFollowsFree [m]
};

/// What the needle would meet then. The tip is imagined where the helix reaches the wall, and stays there; the wall
/// around the helix follows as a membrane does around a point load, with the logarithm of the distance.
std::optional<NeedleView> imagineNeedle(const Model& model, const Observation& seen, const ImaginedDraw& draw);

}  // namespace vibe
