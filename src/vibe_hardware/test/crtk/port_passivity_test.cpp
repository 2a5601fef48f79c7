// The energy that the port of an arm gives to the hand, for delays, stiffnesses and hands: with observer and controller
// it stays below the capacity; without them some of the same cases exceed it.
#include "vibe_hardware/crtk/port_passivity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <functional>
#include <random>
#include <vector>

namespace vibe::hardware::port_passivity_test {
namespace {

constexpr double kFine = 1e-4;    // step of the true motion [s]
constexpr int kFinePerTick = 10;  // the arm measures at 1 kHz

/// The hand: its next position, given time, position, velocity and the force that acts on it now.
using HandModel = std::function<double(double, double, double&, double)>;

/// A mass that a spring and a damper pull to where the person intends.
HandModel massOf(double mass, double damping, double stiffness, double amplitude, double frequency) {
  return [=](double t, double x, double& v, double force) {
    const double intended = amplitude * std::sin(2 * M_PI * frequency * t);
    v += kFine / mass * (force - damping * v - stiffness * (x - intended));
    v = std::clamp(v, -0.5, 0.5);
    return x + kFine * v;
  };
}

/// A hand that moves as it wants.
HandModel sine(double amplitude, double frequency) {
  return [=](double t, double x, double& v, double) {
    const double w = 2 * M_PI * frequency;
    v = std::clamp(amplitude * w * std::cos(w * t), -0.5, 0.5);
    return x + kFine * v;
  };
}

/// A hand that knows the force and yields to it at the speed limit, within a range; at its end it goes back at once.
HandModel yielding(double range) {
  return [=](double, double x, double& v, double force) {
    v = force > 0 ? 0.5 : -0.5;
    return std::clamp(x + kFine * v, -range, range);
  };
}

struct Link {
  double measure_delay = 0;                // from measuring to the controller [s]
  std::function<double(int)> force_delay;  // of the command with this number [s]
  double quantum = 0;                      // of the measurement [m]
};

struct Given {
  double most = 0;   // energy within any interval [J]
  double error = 0;  // root mean square of force sent less force of the spring [N]
  double least_balance = 1;
};

/// The force of the tissue at a time and place.
using Tissue = std::function<double(double, double)>;

Given play(const PortConfig& config, bool controlled, double duration, const Tissue& tissue, const HandModel& hand,
           const Link& link) {
  struct Timed {
    double time, value;
  };
  std::deque<Timed> measurements, forces;
  PortState port = startPort(config, 0);
  Given given;
  double x = 0, v = 0, acting = 0, energy = 0, lowest = 0, sum = 0;
  int sent = 0;
  const auto count = static_cast<int>(duration / kFine);
  for (int i = 0; i < count; ++i) {
    const double t = kFine * i;
    while (!forces.empty() && forces.front().time <= t) acting = forces.front().value, forces.pop_front();
    const double next = hand(t, x, v, acting);
    energy += acting * (next - x);
    x = next;
    lowest = std::min(lowest, energy);
    given.most = std::max(given.most, energy - lowest);
    if (i % kFinePerTick != 0) continue;
    const double now = t + kFine;
    const double seen = link.quantum > 0 ? link.quantum * std::round(x / link.quantum) : x;
    measurements.push_back({now, seen});
    while (!measurements.empty() && measurements.front().time + link.measure_delay <= now + 1e-9) {
      observe(config, measurements.front().time, measurements.front().value, port);
      measurements.pop_front();
    }
    const double wanted = tissue(now, port.position);
    double force = std::clamp(wanted, -config.force_limit, config.force_limit);
    if (controlled) force = command(config, now, wanted, 0, port);
    sum += std::pow(force - wanted, 2);
    given.least_balance = std::min(given.least_balance, port.balance);
    double arrival = now + link.force_delay(sent++);
    if (!forces.empty()) arrival = std::max(arrival, forces.back().time);  // one connection keeps the order
    forces.push_back({arrival, force});
  }
  given.error = std::sqrt(sum / sent);
  return given;
}

std::function<double(int)> constantDelay(double delay) {
  return [=](int) { return delay; };
}

std::function<double(int)> jitter(double delay, unsigned seed) {
  std::vector<double> delays(5000);
  std::mt19937 random(seed);
  for (double& d : delays) d = std::uniform_real_distribution<double>(0, delay)(random);
  return [=](int i) { return delays[static_cast<std::size_t>(i) % delays.size()]; };
}

Tissue spring(double stiffness) {
  return [=](double, double x) { return -stiffness * x; };
}

/// A host whose tissue changes every 16 ms in the worst way it can guess.
Tissue hostile(unsigned seed) {
  return [seed](double t, double) {
    std::mt19937 random(seed + static_cast<unsigned>(t / 0.016));
    return std::uniform_real_distribution<double>(-3, 3)(random);
  };
}

std::vector<HandModel> hands() {
  return {sine(0.01, 1),
          sine(0.01, 5),
          sine(2e-3, 20),
          yielding(0.02),
          yielding(1e-3),
          massOf(0.1, 0.5, 0, 0, 1),
          massOf(0.1, 1, 100, 0.02, 1),
          massOf(0.3, 10, 500, 0.02, 2),
          massOf(0.05, 0.2, 50, 0.01, 4)};
}

TEST(PortPassivity, NoDelayNoStiffnessAndNoHandGetsMoreThanTheCapacity) {
  int exceeded_without = 0, cases = 0;
  double most = 0, least = 1, most_without = 0;
  for (const double delay : {0.0, 0.002, 0.01, 0.03}) {
    PortConfig config;
    config.delay = delay;
    for (const bool jittery : {false, true})
      for (const double measure_delay : {0.0, 0.01})
        for (const Tissue& tissue : {spring(50), spring(300), spring(2000), hostile(1)})
          for (const HandModel& hand : hands()) {
            const Link link{measure_delay, jittery ? jitter(delay, 3) : constantDelay(delay), config.resolution};
            const Given with = play(config, true, 3, tissue, hand, link);
            const Given without = play(config, false, 3, tissue, hand, link);
            ASSERT_LE(with.most, config.capacity) << "delay " << delay << ", case " << cases;
            ASSERT_GE(with.least_balance, 0) << "delay " << delay << ", case " << cases;
            most = std::max(most, with.most), least = std::min(least, with.least_balance);
            most_without = std::max(most_without, without.most);
            exceeded_without += without.most > config.capacity ? 1 : 0;
            ++cases;
          }
  }
  std::printf("%d cases: at most %.1f mJ, least balance %.2f mJ; without controller %d exceed, at most %.0f mJ\n",
              cases, 1e3 * most, 1e3 * least, exceeded_without, 1e3 * most_without);
  EXPECT_GT(exceeded_without, cases / 4);  // negative control: the cases are hard enough
}

TEST(PortPassivity, ASpringThatTheHandPressesIsFeltAsItIs) {
  PortConfig config;
  config.delay = 0.005;
  const Link link{0, constantDelay(0.003), config.resolution};
  const Given slow = play(config, true, 30, spring(300), sine(5e-3, 0.5), link);
  EXPECT_LT(slow.error, 0.1 * 300 * 5e-3 * std::sqrt(0.5));
  const Given fast = play(config, true, 30, spring(300), sine(5e-3, 2), link);
  std::printf("error of the force: %.1f %% at 0.5 Hz, %.1f %% at 2 Hz\n", 100 * slow.error / (1.5 * std::sqrt(0.5)),
              100 * fast.error / (1.5 * std::sqrt(0.5)));
}

TEST(PortPassivity, ALongerDelayThanStatedIsBeyondTheBound) {
  PortConfig config;
  config.delay = 0.002;
  const Link late{0, constantDelay(0.06), config.resolution};
  double most = 0;
  for (const double frequency : {1., 2., 3., 4., 5., 6., 8.})
    most = std::max(most, play(config, true, 20, spring(300), sine(8e-3, frequency), late).most);
  EXPECT_GT(most, config.capacity);  // negative control of the delay that the observer reckons with
}

TEST(PortPassivity, AfterSilenceWhatWasReservedIsBooked) {
  PortConfig config;
  PortState port = startPort(config, 0);
  observe(config, 0, 0, port);
  const double force = command(config, 0, 1, 0, port);
  EXPECT_NEAR(force, 1, 1e-12);
  release(0.02, port);
  rebase(config, 0.2, 0, port);
  // it acted from 0 until it was replaced and the delay longer, at the speed limit at most
  EXPECT_NEAR(port.balance, config.capacity - 0.5 * 1 * 0.03, 1e-12);
}

TEST(PortPassivity, ManyCommandsAreMergedAndStillCovered) {
  PortConfig config;
  config.delay = 0.5;  // far more commands on their way than are kept
  const Link link{0, jitter(0.5, 1), config.resolution};
  EXPECT_LE(play(config, true, 3, hostile(5), yielding(0.02), link).most, config.capacity);
}

}  // namespace
}  // namespace vibe::hardware::port_passivity_test
