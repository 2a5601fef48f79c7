#pragma once
#include <vector>

#include "scenario.hpp"

namespace vibe_firmware {

/// The hand moves both axes away from the equilibrium, waits and lets go. The plant has no dry friction, so that the
/// motion can be compared with theory:
///
/// - second order: J x'' + (B + b) x' + K x = 0, the device as it is meant to be;
/// - sampled: the same with torque held for 1 ms and the velocity filter, solved exactly from tick to tick. What is
/// left
///   is the encoder, the PWM and the firmware's arithmetic.
class ReleaseScenario : public Scenario {
 public:
  std::uint32_t ticks() const override { return 2400; }
  std::array<PlantConfig, kAxisCount> plants() const override;
  void command(std::uint32_t tick, CosimRequest& request) override;
  HandAction hand(std::uint32_t tick, int axis, const AxisPlant& plant) override;
  void observe(const Period& period) override;
  void receive(const CosimReply& reply) override { reports_.receive(reply); }
  bool judge(std::ostream& out) const override;
  bool writeTable(std::ostream& out) const override;

 private:
  ReportWatch reports_;
  std::array<std::vector<double>, kAxisCount> positions_;  // after the release, one per tick
};

}  // namespace vibe_firmware
