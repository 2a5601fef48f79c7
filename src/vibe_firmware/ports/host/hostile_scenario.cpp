#include <limits>
#include <ostream>
#include <random>

#include "scenario.hpp"

namespace vibe_firmware {
namespace {

constexpr double kHandStiffness = 0.3;  // [N m/rad]
constexpr double kHandDamping = 0.02;   // [N m s/rad]

/// A host that sends new parameters at 100 Hz, valid and invalid ones, half of them such that the motor pushes the way
/// the axis moves, and that falls silent at times; a hand that moves about, presses buttons and passes the encoder's
/// index. The axes must not give more than the capacity of the passivity observer beyond what they have received since
/// any moment, and every flag of the device except an encoder fault must have been seen.
class HostileScenario : public Scenario {
 public:
  std::uint32_t ticks() const override { return 20000; }

  void command(std::uint32_t tick, CosimRequest& request) override {
    if (chance(0.01F)) buttons_ = static_cast<std::uint16_t>(random_());
    request.buttons = chance(0.02F) ? static_cast<std::uint16_t>(~buttons_) : buttons_;  // bouncing contacts
    if (tick < silent_until_) return;
    if (tick % 1000 == 500) silent_until_ = tick + 300;
    if (tick % 10 == 3) setParameters({++number_, {someParameters(0), someParameters(1)}}, request);
    if (tick % 10 == 7) getFeature(kStatusReportId, kStatusReportSize, request);
    if (tick % 100 == 13) request.length = static_cast<std::uint16_t>(uniform(0, kCosimData));
  }

  HandAction hand(std::uint32_t, int axis, const AxisPlant& plant) override {
    double& target = target_[static_cast<std::size_t>(axis)];
    if (chance(0.01F)) target = uniform(-1.5F, 1.5F);
    HandAction action;
    action.torque = kHandStiffness * (target - plant.position()) - kHandDamping * plant.velocity();
    return action;
  }

  void observe(const Period& period) override {
    energy_[static_cast<std::size_t>(period.axis)].add(period.torque, period.after - period.before);
  }

  void receive(const CosimReply& reply) override {
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) velocity_[axis] = reply.velocity[axis];
    reports_.receive(reply);
  }

  bool judge(std::ostream& out) const override {
    constexpr int kExpected = kHostSilent | kLimited | kPassivityActs | kRefused | kIndexed0 | kIndexed1;
    out << "flags seen, and those expected: " << int{reports_.flagsSeen()} << " " << kExpected << "\n";
    bool good = reports_.flagsSeen() == kExpected;
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      out << "axis " << axis
          << ", most energy given since any moment, and its bound [J]: " << energy_[axis].fromLowest() << " "
          << AxisConfig{}.energy_capacity << "\n";
      good = good && energy_[axis].fromLowest() <= AxisConfig{}.energy_capacity;
    }
    return good;
  }

 private:
  // Not std::uniform_real_distribution: its values differ between libraries.
  float uniform(float from, float to) { return from + (to - from) * static_cast<float>(random_() >> 8) / 16777216.0F; }

  bool chance(float probability) { return uniform(0, 1) < probability; }

  AxisParameters someParameters(std::size_t axis) {
    if (chance(0.5F)) return pushingParameters(axis);
    AxisParameters parameters;
    parameters.stiffness = chance(0.2F) ? 0 : uniform(0, 0.6F);
    parameters.damping = chance(0.2F) ? 0 : uniform(0, 6e-3F);
    parameters.position = uniform(-1, 1);
    parameters.torque_limit = uniform(0, 0.03F);
    parameters.torque = uniform(-1, 1) * parameters.torque_limit;
    if (chance(0.02F)) parameters.damping = std::numeric_limits<float>::quiet_NaN();
    return parameters;
  }

  // The largest torque in the direction of motion.
  AxisParameters pushingParameters(std::size_t axis) {
    AxisParameters parameters;
    parameters.torque_limit = AxisConfig{}.torque_limit;
    parameters.torque = velocity_[axis] < 0 ? -parameters.torque_limit : parameters.torque_limit;
    return parameters;
  }

  std::mt19937 random_{2026};
  std::uint16_t buttons_ = 0;
  std::uint16_t number_ = 0;
  std::uint32_t silent_until_ = 0;
  std::array<float, kAxisCount> velocity_{};  // as the firmware has it [rad/s]
  ReportWatch reports_;
  std::array<double, kAxisCount> target_{};  // of the hand [rad]
  std::array<PortEnergy, kAxisCount> energy_{PortEnergy{AxisConfig{}}, PortEnergy{AxisConfig{}}};
};

}  // namespace

std::unique_ptr<Scenario> hostileScenario() {
  return std::make_unique<HostileScenario>();
}

}  // namespace vibe_firmware
