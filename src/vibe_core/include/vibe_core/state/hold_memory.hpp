#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace vibe {

/// A contact of the tool with the wall, as it was found when its point was last far from here. Vectors are in the frame
/// of the link that the shape belongs to.
struct KeptContact {
  std::array<int, 3> node{-1, -1, -1};  ///< vertices of its point, -1 behind the last one
  std::array<double, 3> weight{};       ///< of these, sum 1
  int shape = -1;                       ///< of the tool
  bool nearest = false;                 ///< the nearest point of a triangle, elsewhere as soon as the triangle tilts
  double clearance = 0;                 ///< of the mid-surface from the shape [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();       ///< of the tool on the wall in the last step [N]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();       ///< of the point when it was found [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();      ///< unit, out of the shape
  Eigen::Vector3d tool_point = Eigen::Vector3d::Zero();  ///< of the shape's surface [m]
};

/// What the simulator keeps while the hand holds all joints still, see ContactMemory.
struct HoldMemory {
  int steps = 0;                      ///< in a row in which the tool has touched the wall and the hand held still
  std::vector<KeptContact> contacts;  ///< those of the last step; empty until it counts as holding
};

}  // namespace vibe
