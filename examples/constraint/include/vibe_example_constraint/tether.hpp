#pragma once
#include <Eigen/Core>

/// A linear spring from one particle to a fixed point of the world.
struct Tether {
  int particle = 0;
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  ///< in world [m]
  double stiffness = 0;                           ///< [N/m], above 0
};

/// Simulations whose Workspace is made from now on have this tether.
/// @throws vibe::Error if there is a tether already
void registerTether(const Tether& tether);
