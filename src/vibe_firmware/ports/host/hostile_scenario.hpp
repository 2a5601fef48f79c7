#pragma once
#include <random>

#include "scenario.hpp"

namespace vibe_firmware {

/// A host that sends new parameters at 100 Hz, valid and invalid ones, half of them such that the motor pushes the way
/// the axis moves, and that falls silent at times; a hand that moves about, presses buttons and passes the encoder's
/// index. The axes must not give more than the capacity of the passivity observer beyond what they have received since
/// any moment, and every flag of the device except an encoder fault must have been seen.
class HostileScenario : public Scenario {
 public:
  std::uint32_t ticks() const override { return 20000; }
  void command(std::uint32_t tick, CosimRequest& request) override;
  HandAction hand(std::uint32_t tick, int axis, const AxisPlant& plant) override;
  void observe(const Period& period) override {
    energy_[static_cast<std::size_t>(period.axis)].add(period.torque, period.after - period.before);
  }
  void receive(const CosimReply& reply) override;
  bool judge(std::ostream& out) const override;

 private:
  float uniform(float from, float to);
  bool chance(float probability) { return uniform(0, 1) < probability; }
  AxisParameters someParameters(std::size_t axis);
  AxisParameters pushingParameters(std::size_t axis);

  std::mt19937 random_{2026};
  std::uint16_t buttons_ = 0;
  std::uint16_t number_ = 0;
  std::uint32_t silent_until_ = 0;
  std::array<float, kAxisCount> velocity_{};  // as the firmware has it [rad/s]
  ReportWatch reports_;
  std::array<double, kAxisCount> target_{};  // of the hand [rad]
  std::array<PortEnergy, kAxisCount> energy_{PortEnergy{AxisConfig{}}, PortEnergy{AxisConfig{}}};
};

}  // namespace vibe_firmware
