#include "vibe_hardware/crtk/hand_rotation.hpp"

#include <cmath>

namespace vibe::hardware {

HandRotation rotationSince(const Eigen::Quaterniond& reference, const Eigen::Quaterniond& orientation,
                           const Eigen::Matrix3d& hand, int axis, const Eigen::Vector3d& stylus, double near) {
  const Eigen::Vector3d before = reference * stylus, now = orientation * stylus;
  const Eigen::Quaterniond turn = orientation * reference.conjugate();
  HandRotation rotation;
  const double twist = 2 * std::atan2(turn.vec().dot(before), turn.w());
  rotation.angles[axis] = twist + 2 * M_PI * std::round((near - twist) / (2 * M_PI));
  rotation.rates.col(axis) = (before + now) / (1 + before.dot(now));
  // the other two axes of the hand, carried to the stylus by the shortest way
  const Eigen::Matrix3d axes = Eigen::Quaterniond::FromTwoVectors(hand.col(axis), before) * hand;
  const Eigen::Vector3d cross = before.cross(now);
  const double sine = cross.norm();
  rotation.swing = std::atan2(sine, before.dot(now));
  const bool swings = sine > 1e-9;
  const Eigen::Vector3d about = swings ? Eigen::Vector3d(cross / sine) : Eigen::Vector3d(axes.col((axis + 1) % 3));
  const double stretch = swings ? rotation.swing / sine : 1;
  for (const int i : {(axis + 1) % 3, (axis + 2) % 3}) {
    const double along = axes.col(i).dot(about), across = axes.col(i).dot(before.cross(about));
    rotation.angles[i] = rotation.swing * along;
    rotation.rates.col(i) = along * about + stretch * across * now.cross(about);
  }
  return rotation;
}

}  // namespace vibe::hardware
