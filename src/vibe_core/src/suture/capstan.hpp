#pragma once
#include <Eigen/Core>

namespace vibe {

/// Angle by which a thread turns at b on its way from a to c [rad], from 0 (straight) to pi (reversal); 0 if two of the
/// points coincide.
double turningAngle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Largest ratio of the tensions on both sides of an eyelet, e^(friction angle) (Euler, Eytelwein: the capstan).
/// @param friction  Coulomb coefficient, 0 or more; infinity prevents sliding
/// @param angle     turn at the eyelet [rad], 0 or more
/// @throws Error    if one is below 0 or not a number
double capstanFactor(double friction, double angle);

/// An eyelet with at least this capstan factor holds like a knot.
constexpr double kHoldingFactor = 1e4;

}  // namespace vibe
