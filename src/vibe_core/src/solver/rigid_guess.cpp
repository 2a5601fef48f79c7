#include "solver/rigid_guess.hpp"

#include <Eigen/Geometry>

#include "common/turn.hpp"

namespace vibe {

void moveRigidly(const ElasticBody& body, const MotionView& motion, const TimeScheme& scheme,
                 StepperWorkspace& scratch) {
  const auto at = [&](int i) { return Eigen::Map<Eigen::Vector3d>(&scratch.z[4 * i]); };
  const auto move = [&](int i) {
    Eigen::Vector3d sum;
    for (int k = 0; k < 3; ++k)
      sum[k] = scheme.free_z(0, motion.v[k][i], motion.a[k][i]) + scheme.z_gain * motion.a[k][i];
    return sum;
  };
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), shift = center, spin = center;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  double mass = 0;
  for (int i = 0; i < body.nodeCount(); ++i) {
    mass += body.mass[i];
    center += body.mass[i] * at(i);
    shift += body.mass[i] * move(i);
  }
  center /= mass, shift /= mass;
  for (int i = 0; i < body.nodeCount(); ++i) {
    const Eigen::Vector3d arm = at(i) - center;
    spin += body.mass[i] * arm.cross(move(i));
    inertia += body.mass[i] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  inertia += 1e-9 * inertia.trace() * Eigen::Matrix3d::Identity();  // of nodes in a line
  const Eigen::Vector3d turn = inertia.ldlt().solve(spin);
  const double angle = turn.norm();
  const Eigen::Matrix3d rotation =
      rotationAbout(angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX(), angle);
  for (int i = 0; i < body.nodeCount(); ++i) at(i) = center + shift + rotation * Eigen::Vector3d(at(i) - center);
}

}  // namespace vibe
