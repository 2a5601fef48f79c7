#pragma once

#include <algorithm>
#include <array>
#include <iosfwd>
#include <memory>
#include <string>

#include "axis_plant.hpp"
#include "cosim_frame.hpp"
#include "vibe_firmware/core/axis.hpp"

namespace vibe_firmware {

/// Puts a control request of the host into a frame. Requests of USB 2.0, table 9-4, and HID 1.11, 7.2.
void setConfiguration(CosimRequest& request);
void setParameters(const ParameterReport& parameters, CosimRequest& request);
void getFeature(std::uint8_t id, std::uint16_t length, CosimRequest& request);

/// Remembers what the input reports of a run have said.
class ReportWatch {
 public:
  void receive(const CosimReply& reply) {
    if (reply.has_report == 0 || !unpack(reply.report, sizeof reply.report, last_)) return;
    flags_ = static_cast<std::uint8_t>(flags_ | last_.flags);
  }

  std::uint8_t flagsSeen() const { return flags_; }

  /// The firmware has taken the parameters with this number, and neither refused nor cut them.
  bool parametersInForce(std::uint16_t number) const {
    return last_.parameter_number == number && !(last_.flags & kHostSilent) &&
           !(flags_ & (kRefused | kPassivityActs | kEncoderFault));
  }

 private:
  InputReport last_;
  std::uint8_t flags_ = 0;
};

/// Energy that an axis gives to the hand: what the motor gives, less what the friction of the hardware takes. The motor
/// gives F dx per period; viscous and dry friction take at least b dx^2/T + f_c |dx|, whatever the motion in between.
class PortEnergy {
 public:
  explicit PortEnergy(const AxisConfig& config) : config_(config) {}

  /// One period with this torque [N m] and motion [rad].
  void add(double torque, double motion) {
    const double distance = motion < 0 ? -motion : motion;
    energy_ += torque * motion - config_.viscous_friction * motion * motion / config_.sample_period -
               config_.coulomb_friction * distance;
    lowest_ = std::min(lowest_, energy_);
    from_start_ = std::max(from_start_, energy_);
    from_lowest_ = std::max(from_lowest_, energy_ - lowest_);
  }

  double fromStart() const { return from_start_; }    ///< largest since the start [J]
  double fromLowest() const { return from_lowest_; }  ///< largest since any earlier moment [J]
  double final() const { return energy_; }

 private:
  AxisConfig config_;
  double energy_ = 0;
  double lowest_ = 0;
  double from_start_ = 0;
  double from_lowest_ = 0;
};

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

std::unique_ptr<Scenario> hostileScenario();  ///< see HostileScenario
std::unique_ptr<Scenario> passiveScenario();  ///< see PassiveScenario
std::unique_ptr<Scenario> releaseScenario();  ///< see ReleaseScenario

}  // namespace vibe_firmware
