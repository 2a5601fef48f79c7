#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "vibe_firmware/core/axis_control.hpp"
#include "vibe_firmware/core/passivity.hpp"

// The condition for viscous friction against the frequency response of the real control function (Colgate and Schenkel,
// Journal of Robotic Systems 14(1), 1997), with and without a delay of the torque.
//
// Between two samples the hand moves by p while the old torque is still held (t_d), then by r (T - t_d). With friction
// b it loses at least b (p^2/t_d + r^2/(T - t_d)), and gains F_k r_k + F_(k-1) p_k. At each frequency both are
// quadratic forms in p and r; the friction that is needed is their largest generalised eigenvalue.

namespace vibe_firmware::frequency_sweep_test {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = 3.14159265358979323846;
constexpr int kFrequencies = 2000;

AxisConfig axis(float pole, float delay) {
  AxisConfig config;
  config.safety_factor = 1;
  config.velocity_pole = pole;
  config.output_delay = delay * config.sample_period;
  config.torque_limit = 1e6F;  // linear
  config.speed_limit = 1e6F;
  config.energy_capacity = 1e30F;
  return config;
}

AxisParameters springDamper(float stiffness, float damping) {
  AxisParameters parameters;
  parameters.stiffness = stiffness;
  parameters.damping = damping;
  parameters.torque_limit = 1e6F;
  return parameters;
}

/// Torque of the real function after the shaft has jumped by one radian: -(K + B ...), tick by tick until it is still.
std::vector<double> stepResponse(const AxisConfig& config, const AxisParameters& parameters) {
  constexpr std::int32_t kJump = 1000000;
  AxisState state = initialAxisState(config);
  state.spring_gain = 1;
  state.torque_limit = parameters.torque_limit;
  step(config, parameters, 1, 32, {0, false, 0}, state);
  const double jump = static_cast<double>(kJump) * config.radians_per_count;
  std::vector<double> response;
  for (int k = 0; k < 400; ++k)
    response.push_back(step(config, parameters, 1, 32, {static_cast<std::uint32_t>(kJump), false, 0}, state) / jump);
  return response;
}

/// F(z)/X(z) of the step response, at z = e^(j theta).
Complex transfer(const std::vector<double>& response, double theta) {
  Complex sum = response[0];
  for (std::size_t k = 1; k < response.size(); ++k)
    sum += (response[k] - response[k - 1]) * std::polar(1.0, -theta * static_cast<double>(k));
  return sum;
}

/// Viscous friction that this frequency needs. F = G (p + r) with G = H/(z - 1).
double needed(Complex h, double theta, double period, double delay) {
  const Complex z = std::polar(1.0, theta);
  const Complex g = h / (z - 1.0);
  const double share = delay / period;
  const Complex c = std::conj(g) * (1 - share + share * z);
  const double inside = std::norm(g) - c.imag() * c.imag();
  return period / 2 * (c.real() + std::sqrt(std::max(0.0, inside)));
}

double needed(const AxisConfig& config, const AxisParameters& parameters) {
  const std::vector<double> response = stepResponse(config, parameters);
  double most = 0;
  for (int i = 1; i <= kFrequencies; ++i) {
    const double theta = kPi * i / kFrequencies;
    most = std::max(most, needed(transfer(response, theta), theta, config.sample_period, config.output_delay));
  }
  return most;
}

TEST(FrequencySweep, WithoutDelayTheConditionIsExact) {
  for (const float pole : {0.0F, 0.5F, 0.9F, 0.95F})
    for (const auto& [stiffness, damping] : {std::pair{1.0F, 0.0F}, {0.0F, 2e-3F}, {1.0F, 2e-3F}, {0.3F, 2e-2F}}) {
      const AxisConfig config = axis(pole, 0);
      const double condition = requiredViscousFriction(config, stiffness, damping);
      EXPECT_NEAR(needed(config, springDamper(stiffness, damping)), condition, 1e-3 * condition)
          << "pole " << pole << ", K " << stiffness << ", B " << damping;
    }
}

TEST(FrequencySweep, WithDelayTheConditionIsEnough) {
  for (const float pole : {0.0F, 0.5F, 0.9F, 0.95F})
    for (const float delay : {0.01F, 0.05F, 0.2F, 0.5F, 1.0F})
      for (const auto& [stiffness, damping] : {std::pair{1.0F, 0.0F}, {0.0F, 2e-3F}, {1.0F, 2e-3F}, {0.3F, 2e-2F}}) {
        const AxisConfig config = axis(pole, delay);
        EXPECT_LE(needed(config, springDamper(stiffness, damping)),
                  1.0001 * requiredViscousFriction(config, stiffness, damping))
            << "pole " << pole << ", delay " << delay << ", K " << stiffness << ", B " << damping;
      }
}

// For a spring alone the factor of the delay is exact, and b > K T (1/2 + t_d/T) would be too little.
TEST(FrequencySweep, DelayOfASpringNeedsMoreThanTheTimeOfTheDelay) {
  for (const float delay : {0.05F, 0.2F, 0.5F}) {
    const AxisConfig config = axis(0.9F, delay);
    const double found = needed(config, springDamper(1, 0));
    EXPECT_NEAR(found, requiredViscousFriction(config, 1, 0), 1e-3 * found);
    EXPECT_GT(found, 1.02 * 1e-3 * (0.5 + static_cast<double>(delay)));
  }
}

/// Energy per tick that a hand takes out of the real function when it moves slowly back and forth with the split
/// between p and r that frequency theta makes worst.
double slowPump(const AxisConfig& config, const AxisParameters& parameters, double theta) {
  const Complex z = std::polar(1.0, theta);
  const Complex g = transfer(stepResponse(config, parameters), theta) / (z - 1.0);
  const double t_d = config.output_delay, rest = config.sample_period - t_d;
  // eigenvector of (u v^H + v u^H)/2, u = conj(g) (1, 1), v = (conj z, 1), with weights t_d and T - t_d: alpha u + v
  const Complex overlap = std::conj(g) * (t_d * z + rest);
  const double root =
      std::sqrt(std::norm(g) * config.sample_period * config.sample_period - std::pow(overlap.imag(), 2));
  const Complex alpha = (Complex(0, overlap.imag()) + root) / (std::norm(g) * config.sample_period);
  const Complex p = t_d * (std::conj(g) * alpha + std::conj(z)), r = rest * (std::conj(g) * alpha + 1.0);
  const double amplitude = 0.4 / std::abs((p + r) / (z - 1.0));  // [rad]: many counts
  AxisState state = initialAxisState(config);
  state.spring_gain = 1;
  state.torque_limit = parameters.torque_limit;
  double x = (amplitude * ((p + r) / (z - 1.0))).real(), energy = 0, held = 0;
  constexpr int kTicks = 20000;
  for (int k = 0; k < kTicks; ++k) {
    const auto count = static_cast<std::int32_t>(std::lround(x / config.radians_per_count));
    const double torque = step(config, parameters, 1, 32, {static_cast<std::uint32_t>(count), false, 0}, state);
    const double first = amplitude * (p * std::pow(z, k)).real(), second = amplitude * (r * std::pow(z, k)).real();
    const double b = config.viscous_friction;
    if (k > 1000) energy += held * first + torque * second - b * (first * first / t_d + second * second / rest);
    held = torque;
    x += first + second;
  }
  return energy / kTicks;
}

TEST(FrequencySweep, RealFunctionIsPumpedBelowTheConditionAndNotAbove) {
  AxisConfig config = axis(0.9F, 0.2F);
  const AxisParameters parameters = springDamper(1, 0);
  const float needed_friction = requiredViscousFriction(config, 1, 0);
  config.viscous_friction = 0.97F * needed_friction;
  EXPECT_GT(config.viscous_friction, 1e-3F * 0.7F) << "K T (1/2 + t_d/T) is satisfied";
  EXPECT_GT(slowPump(config, parameters, 0.1), 0);
  config.viscous_friction = 1.03F * needed_friction;
  EXPECT_LT(slowPump(config, parameters, 0.1), 0);
}

}  // namespace
}  // namespace vibe_firmware::frequency_sweep_test
