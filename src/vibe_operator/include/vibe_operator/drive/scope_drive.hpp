#pragma once

#include <functional>
#include <set>

#include "vibe_operator/drive/drive_keys.hpp"

namespace vibe::operating {

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

  double position() const { return position_; }         ///< [m] or [rad]
  double velocity() const { return velocity_; }         ///< [m/s] or [rad/s]
  const AxisLimits& limits() const { return limits_; }  ///< as of rest()

 private:
  AxisLimits limits_;
  double position_ = 0, velocity_ = 0;

  double phase(double seconds, double goal, double speed);
  double brake(double seconds, double goal);
  double accelerate(double seconds, double acceleration);
  double cruise(double seconds);
};

/// Position limits and greatest speed of the joints, as the URDF gives them.
struct JointLimit {
  double lower = 0, upper = 0, velocity = 0;  ///< [m] and [m/s], or [rad] and [rad/s]
};
using JointLimits = std::array<JointLimit, kJointCount>;  ///< by DriveJoint

/// A key moves its joint by what it does in this time, at least [s].
constexpr double kTap = 1.0 / 60;

/// How fast keys and mouse move the joints. The limits of the joints apply on top.
struct DriveSpeeds {
  /// While a key is held, at normal speed [1/s]. Design choice: about the pace of the scripted trainees.
  Joints keys = {0.03, 0.8, 0.6, 0.6, 0.015, 12.0, 0.03};
  double slow = 0.25, fast = 2.5;  ///< factors of the other two gears; slow applies to mouse and wheel too
};

/// Keys and mouse of a player, and the joints and buttons that follow from them. Knows no clock: advance() says how
/// much time passes, during which the keys stay as they are.
class ScopeDrive {
 public:
  /// Called when a key of a button goes down or comes up.
  using ButtonChange = std::function<void(int button, bool down)>;
  /// At rest, no keys down. @param button_changed  has to be callable
  explicit ScopeDrive(ButtonChange button_changed) : button_changed_(std::move(button_changed)) {}

  /// Begins at rest at the present position of the joints, which need not be those of before. Keys stay as they are.
  void begin(const JointLimits& limits, const Joints& present);
  void setSpeeds(const DriveSpeeds& speeds) { speeds_ = speeds; }  ///< from now on

  /// @param key  see drive_keys.hpp; one that is down already or does not drive changes nothing
  void keyDown(int key);
  /// A joint brakes when its key comes up, but not before it has moved by kTap: no tap is lost, however short.
  /// @param key  see drive_keys.hpp; one that is up already or does not drive changes nothing
  void keyUp(int key);
  /// All keys come up; moving joints brake. Motion that the mouse has asked for ends too.
  void releaseAll();

  /// Keys of joints come up, as after releaseAll(), and want a new press; buttons stay as they are.
  void releaseJoints();

  /// The mouse asks for a displacement of a joint, before the factor of slow motion; ignored while a key moves it.
  void displace(int joint, double by);

  /// Moves the joints by what the keys that are down and the mouse ask for. @param seconds  0 or more
  void advance(double seconds);

  Joints joints() const;   ///< at present [m] or [rad]
  bool atRest() const;     ///< no joint moves
  DriveGear gear() const;  ///< Slow while a key for that is held, otherwise as chosen last
  const std::set<int>& keysDown() const { return down_; }  ///< that drive, by their numbers
  const JointLimits& limits() const { return limits_; }    ///< as of begin()

 private:
  ButtonChange button_changed_;
  DriveSpeeds speeds_;
  JointLimits limits_{};
  std::array<SmoothAxis, kJointCount> axes_;
  Joints goals_{};
  Joints pressed_{};  // where a joint was when its last key went down
  std::set<int> down_;
  DriveGear chosen_ = DriveGear::Normal;

  int direction(int joint) const;
  double factor() const;
  void change(const KeyBinding& binding, bool down);
  void changeJoint(const KeyBinding& binding, bool down);
  void advanceJoint(int joint, double seconds);
};

}  // namespace vibe::operating
