#pragma once
#include <array>
#include <iosfwd>
#include <string>

#include "axis_plant.hpp"
#include "cosim_frame.hpp"

namespace vibe_firmware {

/// What the hand does with an axis during one period.
struct HandAction {
  bool holds = false;   ///< true: moves the axis to `position`, however strong the motor is
  double position = 0;  ///< [rad]
  double torque = 0;    ///< otherwise pushes with this [N m]
};

/// One period of one axis, as the scenario sees it afterwards.
struct Period {
  std::uint32_t tick = 0;
  int axis = 0;
  double torque = 0;  ///< commanded during the period [N m]
  double before = 0;  ///< true position at its beginning [rad]
  double after = 0;   ///< at its end
};

/// A hand, a host and a judge: what moves the axes, what is sent to the firmware, and whether the outcome is right.
class Scenario {
 public:
  virtual ~Scenario() = default;

  virtual std::uint32_t ticks() const = 0;
  virtual std::array<PlantConfig, kAxisCount> plants() const { return {}; }

  /// Adds buttons and a control request. Tick 0 is preceded by SET_CONFIGURATION.
  virtual void command(std::uint32_t tick, CosimRequest& request) = 0;

  virtual HandAction hand(std::uint32_t tick, int axis, const AxisPlant& plant) = 0;

  virtual void observe(const Period& period) = 0;

  /// What the firmware has answered in a tick.
  virtual void receive(const CosimReply&) {}

  /// Writes what was measured, a `name: value` line each. @return whether every bound holds
  virtual bool judge(std::ostream& out) const = 0;

  /// Writes what was measured over time, as comma-separated values with a heading. @return false: there is no such
  /// table
  virtual bool writeTable(std::ostream&) const { return false; }
};

}  // namespace vibe_firmware
