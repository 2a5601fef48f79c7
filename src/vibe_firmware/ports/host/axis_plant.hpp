#pragma once
#include <cstdint>

#include "vibe_firmware/core/axis.hpp"
#include "vibe_firmware/hal/motor_drive.hpp"

namespace vibe_firmware {

/// What is behind one axis of the haptic device. Friction of the motor's back-EMF comes on top.
struct PlantConfig {
  MotorDrive drive{};
  double inertia = 3e-5;           ///< of motor (5.6e-8 kg m^2 times n^2) and handle [kg m^2]
  double coulomb_friction = 8e-4;  ///< [N m]
  double radians_per_count = AxisConfig{}.radians_per_count;
  std::int32_t counts_per_turn = 2048;  ///< between two index pulses
};

/// One axis: motor on a voltage, inertia, dry friction, encoder. The inductance is left out: 0.42 mH / 19.8 ohm = 21
/// us.
///
///   J w' = n k (U d - n k w) / R - f_c sign(w) + hand
class AxisPlant {
 public:
  explicit AxisPlant(const PlantConfig& config) : config_(config) {}

  /// One period of 1 ms at this mean duty of the bridge. @param hand  torque of the hand [N m]
  void advance(double duty, double hand);

  /// One period in which the hand moves the axis to this position whatever the motor does [rad].
  void moveTo(double position);

  double position() const { return position_; }  ///< [rad]
  double velocity() const { return velocity_; }  ///< [rad/s]

  /// Viscous friction that comes from the back-EMF [N m s/rad].
  double backEmfFriction() const;

  std::int32_t count() const;                                  ///< of the encoder
  bool index() const { return index_; }                        ///< whether the pulse came in the last period
  std::uint32_t indexCounter() const { return index_count_; }  ///< count at that pulse

 private:
  void substep(double duty, double hand, double dt);
  void noteIndex(std::int32_t before);

  PlantConfig config_;
  double position_ = 0;
  double velocity_ = 0;
  bool index_ = false;
  std::uint32_t index_count_ = 0;
};

}  // namespace vibe_firmware
