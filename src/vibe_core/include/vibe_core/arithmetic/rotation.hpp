#pragma once
#include <Eigen/Geometry>

namespace vibe {

/// The least rotation that turns the direction `from` into the direction `to`; lengths do not matter. That of
/// Eigen::Quaterniond::FromTwoVectors(), compiled once: it takes longer to compile than most files.
Eigen::Quaterniond rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace vibe
