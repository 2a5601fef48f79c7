#include "solver/time_scheme.hpp"

#include <Eigen/Geometry>

#include "arithmetic/turn.hpp"

namespace vibe {

TimeScheme::TimeScheme(const StepSettings& settings, double mass_damping, double stiffness_damping)
    : h(settings.step), rate(mass_damping), time(stiffness_damping) {
  double second_order = 1;  // backward Euler does not look at the old acceleration
  if (settings.backward_euler) {
    second_order = 0;
  } else {
    const double r = settings.spectral_radius;
    alpha_m = (2 * r - 1) / (r + 1);
    alpha_f = r / (r + 1);
    gamma = 0.5 - alpha_m + alpha_f;
    beta = 0.25 * (1 - alpha_m + alpha_f) * (1 - alpha_m + alpha_f);
  }
  x_gain = h * h * beta;
  v_gain = h * gamma;
  z_gain = (1 - alpha_f) * (x_gain + time * v_gain);
  inertia = ((1 - alpha_m) + rate * (1 - alpha_f) * v_gain) / z_gain;
  free_v_a = h * (1 - gamma);
  free_x = {h, h * h * (0.5 - beta) * second_order};
  free_z = {(1 - alpha_f) * free_x.v + time, (1 - alpha_f) * (free_x.a + time * free_v_a)};
  hat_z = {free_z.v - rate / inertia, free_z.a - (alpha_m + rate * (1 - alpha_f) * free_v_a) / inertia};
}

void moveRigidly(const ElasticBody& body, const MotionView& motion, const TimeScheme& scheme, std::vector<double>& z) {
  const auto at = [&](int i) { return Eigen::Map<Eigen::Vector3d>(&z[4 * i]); };
  const auto move = [&](int i) {
    Eigen::Vector3d sum;
    for (int k = 0; k < 3; ++k)
      sum[k] = scheme.free_z(0, motion.v[k][i], motion.a[k][i]) + scheme.z_gain * motion.a[k][i];
    return sum;
  };
  // the linear momentum of the nodes' own moves gives the translation
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), shift = center, spin = center;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  double mass = 0;
  for (int i = 0; i < body.nodeCount(); ++i) {
    mass += body.mass[i];
    center += body.mass[i] * at(i);
    shift += body.mass[i] * move(i);
  }
  center /= mass, shift /= mass;
  // their angular momentum gives the turn
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
