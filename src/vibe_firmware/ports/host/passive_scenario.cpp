#include <cmath>
#include <ostream>

#include "scenario.hpp"
#include "vibe_firmware/core/passivity.hpp"

namespace vibe_firmware {
namespace {

constexpr std::uint16_t kParameterNumber = 1;
constexpr float kStiffness = 0.5F;  // of axis 0 [N m/rad]; axis 1 has none
constexpr float kShare = 0.98F;     // of the damping that the firmware accepts beside this stiffness
constexpr double kAmplitude[kAxisCount] = {0.01, 0.02};  // [rad]
constexpr double kFirst = 1, kLast = 100;                // [Hz]
constexpr double kBound = 1e-9;                          // rounding of the sums [J]

// Phase of a sine whose frequency rises exponentially from kFirst to kLast [rad].
double chirp(double time, double duration) {
  const double rate = std::log(kLast / kFirst) / duration;
  return 2 * M_PI * kFirst * (std::exp(rate * time) - 1) / rate;
}

AxisParameters strongest(float stiffness) {
  const AxisConfig config;
  return {stiffness, kShare * maxDamping(config, stiffness), 0, 0, config.torque_limit};
}

/// A hand that is stronger than the motors moves both axes to and fro, from 1 Hz up to 100 Hz, against a stiff spring
/// with damping and against a damper, both nearly as strong as the firmware accepts. The axes start at rest in the
/// equilibrium: they must never have given more energy than they have received.
class PassiveScenario : public Scenario {
 public:
  std::uint32_t ticks() const override { return 20000; }

  void command(std::uint32_t tick, CosimRequest& request) override {
    if (tick % 100 == 1) setParameters({kParameterNumber, {strongest(kStiffness), strongest(0)}}, request);
  }

  HandAction hand(std::uint32_t tick, int axis, const AxisPlant&) override {
    HandAction action;
    action.holds = true;
    const double duration = 1e-3 * ticks();
    action.position = kAmplitude[axis] * std::sin(chirp(1e-3 * (tick + 1), duration));
    return action;
  }

  void observe(const Period& period) override {
    energy_[static_cast<std::size_t>(period.axis)].add(period.torque, period.after - period.before);
  }
  void receive(const CosimReply& reply) override { reports_.receive(reply); }

  bool judge(std::ostream& out) const override {
    bool good = reports_.parametersInForce(kParameterNumber);
    if (!good) out << "the firmware has refused or cut the parameters\n";
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      out << "axis " << axis << ", most energy given since the start, and at the end [J]: " << energy_[axis].fromStart()
          << " " << energy_[axis].final() << "\n";
      good = good && energy_[axis].fromStart() <= kBound;
    }
    return good;
  }

 private:
  ReportWatch reports_;
  std::array<PortEnergy, kAxisCount> energy_{PortEnergy{AxisConfig{}}, PortEnergy{AxisConfig{}}};
};

}  // namespace

std::unique_ptr<Scenario> passiveScenario() {
  return std::make_unique<PassiveScenario>();
}

}  // namespace vibe_firmware
