#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "trainee/operator.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/trainee/observation.hpp"

namespace vibe {

/// What the needle would meet if its arm closed now, as seen beside the device.
struct NeedleView {
  double depth = 0;      ///< of the needle below the mucosa; negative: it passes by [m]
  double thickness = 0;  ///< of the wall there, at rest [m]
  WallPoint where;
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit, of the wall where an imagined helix takes hold; 0: none
};

/// Empty if nothing is near.
std::optional<NeedleView> lookAtNeedle(const Model& model, const Observation& seen);

/// How far the wall is from a place; on a coarse mesh that may be much nearer than its particles [m].
double distanceOfWall(const Eigen::Vector3d& place, const Model& model, const Observation& seen);

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

/// How a place lies in the endoscope's picture.
struct View {
  double distance = 0;  ///< of the tip from the place [m]
  double angle = 0;     ///< from the middle of the picture [rad]
};

View viewOf(const Eigen::Vector3d& place, const Observation& seen);

/// Directions in which the tip can come to a place beside straight before the wall: tilted to four sides, then more or
/// less as it comes from the entry, which takes the least bend.
/// @param outward  of the wall at the place
std::vector<Eigen::Vector3d> obliqueWays(const Eigen::Vector3d& place, const Eigen::Vector3d& outward,
                                         const Model& model);

/// The joints that bring a place best into the middle of the picture: straight before the wall where the scope can,
/// else obliquely.
/// @param outward   of the wall at the place
/// @param distance  of the tip from the place [m]
TraineeHand::Joints bestView(const Eigen::Vector3d& place, const Eigen::Vector3d& outward, double distance,
                             Operator& me);

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
