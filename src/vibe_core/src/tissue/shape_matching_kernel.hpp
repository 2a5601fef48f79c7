#pragma once
#include <cstdint>

namespace vibe {

/// One sweep of shape matching over a range of cluster groups; see ClusterSet for the layout. Uses plain pointers, so
/// that the two translation units of the kernel share no inline code that one of them could compile for the wrong
/// machine.
struct ClusterSweep {
  // constant
  const std::int32_t* row_offset;
  const std::int32_t* particle;
  const double *weight, *rest_x, *rest_y, *rest_z;
  const double *gain, *orientation_weight;
  // in, by particle
  const double *x, *y, *z;  ///< positions [m]
  double substep;           ///< time since the previous sweep [s]; 0: orientations are not predicted
  // in and out, by group and lane
  double *qw, *qx, *qy, *qz;  ///< orientation of the cluster relative to rest, unit quaternion
  double *wx, *wy, *wz;       ///< its angular velocity in world [rad/s]
  // out, by slot: gain * (goal - position) [m]
  double *dx, *dy, *dz;
  // out, by group and lane
  double *area_x, *area_y,
      *area_z;     ///< derivative of the enclosed volume with respect to the position of the centre [m^2]
  double* spread;  ///< weighted mean square distance from the centre of mass [m^2]
};

/// Computes the goal positions of Mueller, Heidelberger, Teschner & Gross 2005 with the orientation of the centre in
/// the moment matrix (Mueller & Chentanez 2011, "Solid simulation with oriented particles"). The rotation follows from
/// a Newton step on the quaternion, starting from the predicted orientation (Kugelstadt, Koschier & Bender 2018, "Fast
/// corotated FEM using operator splitting"). Both instruction paths do the same operations in the same order without
/// fused multiply-add, so they give the same bits.
using ClusterSweepFunction = void (*)(const ClusterSweep& sweep, int first_group, int last_group);
void sweepClustersSse2(const ClusterSweep& sweep, int first_group, int last_group);
void sweepClustersAvx2(const ClusterSweep& sweep, int first_group, int last_group);

/// For the instruction set in use.
ClusterSweepFunction chooseClusterSweep();

}  // namespace vibe
