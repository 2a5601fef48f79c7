#pragma once

namespace vibe::rviz_plugins {

/// Limits of one joint, from the URDF, and how fast its velocity may change. [m] or [rad]
struct AxisLimits {
  double lower = 0, upper = 0;  ///< of the position
  double velocity = 0;          ///< greatest speed, above 0 [1/s]
  double acceleration = 0;      ///< above 0 [1/s^2]
};

/// A joint that moves to a goal in the shortest time with bounded speed and acceleration, so that its velocity has no
/// step. The motion is computed in closed form: two short advances give the same as a long one. It never leaves the
/// limits.
class SmoothAxis {
 public:
  /// Rests at this position, clamped to the limits.
  void rest(const AxisLimits& limits, double position);

  /// @param seconds  0 or more
  /// @param goal     clamped to the limits
  /// @param speed    greatest speed of this motion; clamped to the limit. The axis slows down if it is faster.
  void advance(double seconds, double goal, double speed);

  /// Where the axis comes to rest if it brakes from now on.
  double stoppingPoint() const;

  double position() const { return position_; }
  double velocity() const { return velocity_; }
  const AxisLimits& limits() const { return limits_; }

 private:
  AxisLimits limits_;
  double position_ = 0, velocity_ = 0;

  double phase(double seconds, double goal, double speed);
  double brake(double seconds, double goal);
  double accelerate(double seconds, double acceleration);
  double cruise(double seconds);
};

}  // namespace vibe::rviz_plugins
