#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/solver/body_loads.hpp"

namespace vibe {

/// One force of the tissue on the tool in a step. All of them together are the force on the tool
/// (StepReport::tool_force), and with their levers its torque.
struct ToolContact {
  /// Contact: wall against which a shape of the tool presses; Grip: wall that the helix holds. The values are part of
  /// the message format.
  enum class Kind : std::uint8_t { Contact = 0, Grip = 1 };
  Kind kind = Kind::Contact;  ///< what the force comes from
  int link = -1;              ///< of ToolModel
  int shape = -1;             ///< of ToolModel::shapes(); -1: a grip
  /// Nodes of the wall and their weights; none where the helix holds more than a point: State::grip has what it holds.
  SurfacePoint surface;
  int triangle = -1;             ///< of the organ's surface, the first that has all of these nodes; -1: none
  Region region = Region::Body;  ///< of the node with the largest weight
  Wall wall = Wall::Anterior;    ///< of the same node
  Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< where the force acts at the end of the step, world [m]
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< out of the tool into the wall, unit, world; zero for a grip
  /// From the tool to the face of the wall at the end of the step; below 0: the wall is squeezed by as much. 0 for a
  /// grip. Shape matching: before the particle was pushed out for the last time [m].
  double gap = 0;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< tissue on tool, mean over the step, world [N]

  double normalForce() const { return -force.dot(normal); }  ///< with which wall and tool press on each other [N]
  /// What is left of the force on the tool beside its normal part: friction, and all of it for a grip [N].
  Eigen::Vector3d tangentialForce() const { return force + normalForce() * normal; }
};

}  // namespace vibe
