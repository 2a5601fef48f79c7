#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <vector>

#include "scenario.hpp"

namespace vibe_firmware {
namespace {

constexpr std::uint16_t kParameterNumber = 1;
constexpr std::uint32_t kArrival = 200;  // of the hand at the displacement [ticks]
constexpr std::uint32_t kRelease = 400;
constexpr double kPeriod = 1e-3;
constexpr double kInertia = 1e-3;            // of a handle with a heavy instrument [kg m^2]
constexpr double kSecondOrderBound = 0.025;  // of the displacement, rms
constexpr double kSampledBound = 0.002;

struct Axis {
  AxisParameters parameters;
  double displacement;  // [rad]
};

// Both settings pass the passivity conditions of the default motor.
const Axis kAxes[kAxisCount] = {{{0.1F, 4e-3F, 0, 0, 0.029F}, 0.08}, {{0.3F, 6e-3F, 0, 0, 0.029F}, 0.06}};

double backEmfFriction() {
  return AxisPlant(PlantConfig{}).backEmfFriction();
}

// Free motion of a damped oscillator from rest at 1.
double secondOrder(const AxisParameters& parameters, double time) {
  const double natural = std::sqrt(parameters.stiffness / kInertia);
  const double ratio = (parameters.damping + backEmfFriction()) / (2 * kInertia * natural);
  const double damped = natural * std::sqrt(1 - ratio * ratio);
  const double phase = damped * time;
  return std::exp(-ratio * natural * time) * (std::cos(phase) + ratio * natural / damped * std::sin(phase));
}

// The same with the torque of each tick held for one period, and the velocity filter of the firmware.
std::vector<double> sampled(const AxisParameters& parameters, std::size_t count) {
  const double rate = backEmfFriction() / kInertia;
  const double decay = std::exp(-rate * kPeriod);
  const double pole = AxisConfig{}.velocity_pole;
  std::vector<double> positions{1};
  double velocity = 0, filtered = 0, before = 1;
  while (positions.size() < count) {
    const double x = positions.back();
    filtered = pole * filtered + (1 - pole) * (x - before) / kPeriod;
    const double torque = -parameters.stiffness * x - parameters.damping * filtered;
    const double final_velocity = torque / backEmfFriction();
    positions.push_back(x + final_velocity * kPeriod + (velocity - final_velocity) * (1 - decay) / rate);
    velocity = final_velocity + (velocity - final_velocity) * decay;
    before = x;
  }
  return positions;
}

struct Error {
  double rms = 0;
  double largest = 0;
};

Error difference(const std::vector<double>& measured, double scale, const std::function<double(std::size_t)>& theory) {
  Error error;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double e = std::abs(measured[i] / scale - theory(i));
    error.rms += e * e / static_cast<double>(measured.size());
    error.largest = std::max(error.largest, e);
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

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

  std::array<PlantConfig, kAxisCount> plants() const override {
    PlantConfig plant;
    plant.inertia = kInertia;
    plant.coulomb_friction = 0;
    return {plant, plant};
  }

  void command(std::uint32_t tick, CosimRequest& request) override {
    if (tick % 100 == 1) setParameters({kParameterNumber, {kAxes[0].parameters, kAxes[1].parameters}}, request);
  }

  HandAction hand(std::uint32_t tick, int axis, const AxisPlant&) override {
    HandAction action;
    action.holds = tick < kRelease;
    action.position = kAxes[axis].displacement * std::min(1.0, static_cast<double>(tick) / kArrival);
    return action;
  }

  void observe(const Period& period) override {
    if (period.tick >= kRelease) positions_[static_cast<std::size_t>(period.axis)].push_back(period.before);
  }

  void receive(const CosimReply& reply) override { reports_.receive(reply); }

  bool judge(std::ostream& out) const override {
    bool good = reports_.parametersInForce(kParameterNumber);
    if (!good) out << "the firmware has refused or cut the parameters\n";
    for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
      const AxisParameters& parameters = kAxes[axis].parameters;
      const std::vector<double> exact = sampled(parameters, positions_[axis].size());
      const double scale = kAxes[axis].displacement;
      const Error order = difference(positions_[axis], scale, [&](std::size_t i) {
        return secondOrder(parameters, kPeriod * static_cast<double>(i));
      });
      const Error samples = difference(positions_[axis], scale, [&](std::size_t i) { return exact[i]; });
      out << "axis " << axis << ", second order, rms and largest error [% of the displacement]: " << 100 * order.rms
          << " " << 100 * order.largest << "\n"
          << "axis " << axis << ", sampled, rms and largest error [% of the displacement]: " << 100 * samples.rms << " "
          << 100 * samples.largest << "\n";
      good = good && order.rms < kSecondOrderBound && samples.rms < kSampledBound;
    }
    return good;
  }

  bool writeTable(std::ostream& out) const override {
    out << "time,axis 0,second order 0,sampled 0,axis 1,second order 1,sampled 1\n";
    const std::size_t count = positions_[0].size();
    const std::vector<double> exact[] = {sampled(kAxes[0].parameters, count), sampled(kAxes[1].parameters, count)};
    for (std::size_t i = 0; i < count; ++i) {
      const double time = kPeriod * static_cast<double>(i);
      out << time;
      for (std::size_t axis = 0; axis < kAxisCount; ++axis)
        out << "," << positions_[axis][i] / kAxes[axis].displacement << "," << secondOrder(kAxes[axis].parameters, time)
            << "," << exact[axis][i];
      out << "\n";
    }
    return true;
  }

 private:
  ReportWatch reports_;
  std::array<std::vector<double>, kAxisCount> positions_;  // after the release, one per tick
};

}  // namespace

std::unique_ptr<Scenario> releaseScenario() {
  return std::make_unique<ReleaseScenario>();
}

}  // namespace vibe_firmware
