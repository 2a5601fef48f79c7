#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "vibe_firmware/core/haptic_device.hpp"
#include "vibe_firmware/core/passivity.hpp"

// A host that sends what it likes, 100 times a second, together with a hand that wants energy. Whatever they do, an
// axis gives the hand no more than its capacity beyond what the hand has put in since.

namespace vibe_firmware::hostile_host_test {
namespace {

constexpr int kTicks = 1000000;
constexpr double kPeriod = 1e-3;

/// Largest energy that was given within any interval so far.
class LargestGift {
 public:
  void add(double energy) {
    now_ += energy;
    lowest_ = std::min(lowest_, now_);
    largest_ = std::max(largest_, now_ - lowest_);
  }
  double value() const { return largest_; }

 private:
  double now_ = 0, lowest_ = 0, largest_ = 0;
};

/// One shaft with a hand on it.
struct Shaft {
  double position = 0;   // [rad]
  double velocity = 0;   // of this tick [rad/s]
  float torque = 0;      // held during it [N m]
  LargestGift measured;  // torque times measured motion
  LargestGift net;       // torque times motion, less the friction of the axis

  std::uint32_t count(const AxisConfig& axis) const {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(position / axis.radians_per_count))) &
           0xFFFF;
  }
};

class Session {
 public:
  explicit Session(const HapticConfig& config, unsigned seed) : config_(config), random_(seed) {}
  virtual ~Session() = default;

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      if (i % 10 == 0) setParameters(config_, parametersOfHost(), state_);
      for (Shaft& shaft : shafts_) {
        shaft.velocity = velocityOfHand(shaft);
        move(shaft);
      }
      control();
    }
  }

  /// Index pulses at random ticks, up to an eighth of a turn from where they should be.
  void addWrongPulses() { wrong_pulses_ = true; }

  double measured() const { return std::max(shafts_[0].measured.value(), shafts_[1].measured.value()); }
  /// Whether a pulse has corrected the count of axis 0, which is then no longer that of the shaft.
  bool isCorrected() const {
    const EncoderState& encoder = state_.axes[0].encoder;
    return ((encoder.counter - first_counter_) & 0xFFFF) != (static_cast<std::uint32_t>(encoder.count) & 0xFFFF);
  }
  double net() const { return std::max(shafts_[0].net.value(), shafts_[1].net.value()); }
  const HapticState& state() const { return state_; }
  bool sane() const { return sane_; }

 protected:
  virtual ParameterReport parametersOfHost() = 0;
  virtual double velocityOfHand(const Shaft& shaft) = 0;

  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  const AxisConfig& axis() const { return config_.axes[0]; }

  HapticConfig config_;
  HapticState state_ = initialState(config_);
  std::array<Shaft, kAxisCount> shafts_{};

 private:
  void move(Shaft& shaft) {
    const double step = axis().radians_per_count;
    const double before = std::floor(shaft.position / step);
    const double motion = shaft.velocity * kPeriod;
    shaft.position += motion;
    const double counted = (std::floor(shaft.position / step) - before) * step;
    shaft.measured.add(shaft.torque * counted);
    shaft.net.add(shaft.torque * motion - axis().viscous_friction * motion * motion / kPeriod -
                  axis().coulomb_friction * std::fabs(motion));
  }

  void control() {
    HapticSample sample;
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      sample.counter[i] = shafts_[i].count(config_.axes[i]);
      if (wrong_pulses_ && uniform(0, 1) < 0.02F) addWrongPulse(i, sample);
    }
    if (!state_.axes[0].encoder.started) first_counter_ = sample.counter[0];
    const std::array<float, kAxisCount> torque = step(config_, sample, state_);
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      sane_ = sane_ && std::fabs(torque[i]) <= config_.axes[i].torque_limit && state_.axes[i].energy.balance >= 0;
      shafts_[i].torque = torque[i];
    }
  }

  void addWrongPulse(std::size_t i, HapticSample& sample) {
    const EncoderState& encoder = state_.axes[i].encoder;
    const auto turn = static_cast<int>(config_.axes[i].counts_per_turn);
    const int count = encoder.count + static_cast<std::int16_t>(sample.counter[i] - encoder.counter);
    const int right = encoder.index_count +
                      turn * static_cast<int>(std::floor(static_cast<double>(count - encoder.index_count) / turn));
    const int pulse = right + static_cast<int>(uniform(-0.124F, 0.124F) * static_cast<float>(turn));
    sample.index[i] = true;
    sample.index_counter[i] = static_cast<std::uint32_t>(static_cast<int>(sample.counter[i]) + pulse - count) & 0xFFFF;
  }

  std::mt19937 random_;
  bool sane_ = true;
  bool wrong_pulses_ = false;
  std::uint32_t first_counter_ = 0;  // of axis 0, where its count is 0
};

/// Valid, invalid and senseless sets; the hand wanders.
class RandomSession : public Session {
 public:
  using Session::Session;

 protected:
  ParameterReport parametersOfHost() override {
    ParameterReport report;
    for (AxisParameters& p : report.axes) {
      p.damping = uniform(0, 0.3F) * maxDamping(axis(), 0);
      p.stiffness = uniform(0, 1) * maxStiffness(axis(), p.damping);
      p.position = static_cast<float>(shafts_[0].position) + uniform(-1, 1);
      p.torque = uniform(-1, 1) * axis().torque_limit;
      p.torque_limit = uniform(0, 1) * axis().torque_limit;
      if (uniform(0, 1) < 0.2F) spoil(p);
    }
    return report;
  }

  double velocityOfHand(const Shaft& shaft) override {
    constexpr double kYielding = 400;  // [rad/s per N m]
    return std::clamp(0.98 * shaft.velocity + uniform(-5, 5) + kYielding * shaft.torque, -60.0, 60.0);
  }

 private:
  void spoil(AxisParameters& p) {
    const float values[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1, 1e30F};
    float* const fields[] = {&p.stiffness, &p.damping, &p.position, &p.torque, &p.torque_limit};
    *fields[static_cast<int>(uniform(0, 4.999F))] = values[static_cast<int>(uniform(0, 3.999F))];
  }
};

/// Host and hand are in league: the host pushes where the hand is about to go, and the hand goes there.
class ConspiringSession : public Session {
 public:
  ConspiringSession(const HapticConfig& config, unsigned seed, float damping)
      : Session(config, seed), damping_(damping) {}

 protected:
  ParameterReport parametersOfHost() override {
    direction_ = uniform(0, 1) < 0.3F ? -direction_ : direction_;
    ParameterReport report;
    for (AxisParameters& p : report.axes) {
      p.damping = damping_ * maxDamping(axis(), 0);
      p.stiffness = uniform(0, 1) * maxStiffness(axis(), p.damping);
      p.torque = direction_ * axis().torque_limit;
      p.position = static_cast<float>(shafts_[0].position);
      p.torque_limit = axis().torque_limit;
    }
    return report;
  }

  double velocityOfHand(const Shaft& shaft) override {
    const double pull = shaft.torque;
    return uniform(0, 1) < 0.9F ? std::copysign(uniform(0, 25), pull) : uniform(-90, 90);
  }

 private:
  float damping_;
  float direction_ = 1;
};

/// The host moves the torque up and down while the hand stays within one encoder step, which the observer cannot see.
class HiddenMotionSession : public Session {
 public:
  using Session::Session;

 protected:
  ParameterReport parametersOfHost() override {
    direction_ = -direction_;
    ParameterReport report;
    for (AxisParameters& p : report.axes) {
      p.torque = direction_ * axis().torque_limit;
      p.torque_limit = axis().torque_limit;
    }
    return report;
  }

  double velocityOfHand(const Shaft& shaft) override {
    if (std::fabs(shaft.torque) < 0.5F * std::fabs(largest_)) return 0;  // waits for the torque
    largest_ = std::max(std::fabs(shaft.torque), 0.99F * largest_);
    const double step = axis().radians_per_count;
    const double target = shaft.torque > 0 ? 0.999 * step : 0.001 * step;
    return (target - shaft.position) / kPeriod;
  }

 private:
  float direction_ = 1;
  float largest_ = 0;  // torque of late
};

HapticConfig withCapacity(float capacity) {
  HapticConfig config;
  for (AxisConfig& axis : config.axes) axis.energy_capacity = capacity;
  return config;
}

constexpr float kCapacity = 0.05F;
constexpr float kNoObserver = 1e30F;
constexpr double kRounding = 1.0001;

/// What the quantised measurement hides at a single moment: half a count on either side.
double hidden(const HapticConfig& config) {
  return static_cast<double>(config.axes[0].torque_limit) * config.axes[0].radians_per_count;
}

TEST(HostileHost, RandomSetsNeverGiveMoreThanTheCapacity) {
  const HapticConfig config = withCapacity(kCapacity);
  RandomSession session(config, 1);
  session.run(kTicks);
  EXPECT_TRUE(session.sane());
  EXPECT_LE(session.measured(), kCapacity * kRounding);
  EXPECT_LE(session.net(), kCapacity * kRounding + hidden(config));
  EXPECT_GT(session.state().status.accepted, 50000U);
  EXPECT_GT(session.state().status.refused, 20000U);
  EXPECT_FALSE(session.isCorrected());
  EXPECT_FALSE(session.state().status.flags & kEncoderFault);
  RecordProperty("most_given_J", std::to_string(session.measured()));
}

TEST(HostileHost, ConspiracyOfHostAndHandGetsNoMoreThanTheCapacity) {
  for (const float damping : {0.0F, 0.5F, 1.0F}) {
    const HapticConfig config = withCapacity(kCapacity);
    ConspiringSession session(config, 2, damping);
    session.run(kTicks);
    EXPECT_TRUE(session.sane());
    EXPECT_LE(session.measured(), kCapacity * kRounding) << "damping " << damping;
    EXPECT_LE(session.net(), kCapacity * kRounding + hidden(config)) << "damping " << damping;
    EXPECT_GT(session.measured(), 0.5 * kCapacity) << "the test must come near the bound; damping " << damping;
    RecordProperty("most_given_J", std::to_string(session.measured()));
  }
}

TEST(HostileHost, WrongIndexPulsesGiveNoMoreThanTheCapacity) {
  const HapticConfig config = withCapacity(kCapacity);
  ConspiringSession session(config, 4, 0.5F);
  session.addWrongPulses();
  session.run(kTicks);
  EXPECT_TRUE(session.sane());
  EXPECT_FALSE(session.state().status.flags & kEncoderFault);
  EXPECT_TRUE(session.isCorrected());
  EXPECT_LE(session.measured(), kCapacity * kRounding);
  EXPECT_LE(session.net(), kCapacity * kRounding + hidden(config));
  EXPECT_GT(session.measured(), 0.5 * kCapacity) << "the test must come near the bound";
}

TEST(HostileHost, MotionWithinOneCountGetsNoMoreThanTheCapacity) {
  const HapticConfig config = withCapacity(0.002F);
  HiddenMotionSession session(config, 3);
  session.run(kTicks);
  EXPECT_TRUE(session.sane());
  EXPECT_LE(session.net(), 0.002 * kRounding + hidden(config));
  EXPECT_GT(session.net(), 0.5 * 0.002) << "the test must come near the bound";
  RecordProperty("most_given_J", std::to_string(session.net()));
}

// Negative controls: the same without the observer.
TEST(HostileHost, WithoutObserverEveryoneGetsMore) {
  RandomSession random(withCapacity(kNoObserver), 1);
  random.run(kTicks);
  EXPECT_GT(random.measured(), 10 * kCapacity);
  ConspiringSession conspiracy(withCapacity(kNoObserver), 2, 0.5F);
  conspiracy.run(kTicks);
  EXPECT_GT(conspiracy.measured(), 1000 * kCapacity);
  HiddenMotionSession hidden_motion(withCapacity(kNoObserver), 3);
  hidden_motion.run(kTicks);
  EXPECT_GT(hidden_motion.net(), 10 * 0.002);
  RecordProperty("random_J", std::to_string(random.measured()));
  RecordProperty("conspiracy_J", std::to_string(conspiracy.measured()));
  RecordProperty("hidden_motion_J", std::to_string(hidden_motion.net()));
}

}  // namespace
}  // namespace vibe_firmware::hostile_host_test
