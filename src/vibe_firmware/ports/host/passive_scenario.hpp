#pragma once
#include "scenario.hpp"

namespace vibe_firmware {

/// A hand that is stronger than the motors moves both axes to and fro, from 1 Hz up to 100 Hz, against a stiff spring
/// with damping and against a damper, both nearly as strong as the firmware accepts. The axes start at rest in the
/// equilibrium: they must never have given more energy than they have received.
class PassiveScenario : public Scenario {
 public:
  std::uint32_t ticks() const override { return 20000; }
  void command(std::uint32_t tick, CosimRequest& request) override;
  HandAction hand(std::uint32_t tick, int axis, const AxisPlant& plant) override;
  void observe(const Period& period) override {
    energy_[static_cast<std::size_t>(period.axis)].add(period.torque, period.after - period.before);
  }
  void receive(const CosimReply& reply) override { reports_.receive(reply); }
  bool judge(std::ostream& out) const override;

 private:
  ReportWatch reports_;
  std::array<PortEnergy, kAxisCount> energy_{PortEnergy{AxisConfig{}}, PortEnergy{AxisConfig{}}};
};

}  // namespace vibe_firmware
