#include "vibe_hardware/emulator/arm_loop.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "vibe_core/program/error.hpp"
#include "vibe_hardware/crtk/arm_age.hpp"
#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware {
namespace {

constexpr int kStepsPerSample = 10;                         // of the arm
constexpr double kSample = kStepsPerSample * kArmLoopStep;  // [s]
constexpr double kNews = 1.0 / 60;                          // of the tissue [s]
constexpr double kForcePeriod = 5e-3;                       // of crtk_teleop without measurements [s]
constexpr double kOutages = 2;                              // between their beginnings [s]
constexpr double kHandSpeed = 0.5;                          // at most [m/s]
constexpr double kMissed = 0.2;                             // share of a force, from which it is said

/// One direction.
template <class Message>
class Way {
 public:
  Way(const ArmLink& link, double delay, unsigned seed) : link_(link), delay_(delay), random_(seed) {}

  void send(double now, const Message& message) {
    const double early = uniform() * link_.jitter, chance = uniform();
    if (chance < link_.loss || std::fmod(now, kOutages) > kOutages - link_.outage) return;
    const double arrival = now + std::max(0.0, delay_ - early);
    queue_.push_back({queue_.empty() ? arrival : std::max(arrival, queue_.back().arrival), message});
  }
  /// @return whether there is one that has arrived
  bool take(double now, Message& message) {
    if (queue_.empty() || queue_.front().arrival > now + 1e-9) return false;
    message = queue_.front().message;
    queue_.pop_front();
    return true;
  }

 private:
  struct Timed {
    double arrival;
    Message message;
  };
  const ArmLink& link_;
  double delay_;
  std::mt19937 random_;
  std::deque<Timed> queue_;

  double uniform() { return std::generate_canonical<double, 32>(random_); }
};

/// Any place of the joint is within.
ToolLimits wideLimits() {
  ToolLimits limits{};
  for (auto& limit : limits) limit.lower = -10, limit.upper = 10, limit.velocity = 10;
  return limits;
}

class ArmLoop {
 public:
  explicit ArmLoop(const ArmLoopSettings& settings)
      : settings_(settings),
        mapping_(settings.mapping),
        insertion_(mapping_.joints[Insertion]),
        state_(startTeleop(mapping_, 0)),
        measurements_(settings.link, settings.link.measurements, 2 * settings.link.seed),
        forces_(settings.link, settings.link.forces, 2 * settings.link.seed + 1) {
    if (insertion_.coordinate < 0 || insertion_.coordinate > HandZ || mapping_.force_frame != ForceFrame::Base)
      throw Error(
          "The mapping '" + mapping_.name +
          "' does not move the insertion along an axis of the hand with forces in the base; name one that does.");
    axis_ = mapping_.hand.col(insertion_.coordinate);
    input_.ready = input_.live = true;
  }

  ArmLoopResult run() {
    double sum = 0;
    const auto count = static_cast<int>(settings_.duration / kArmLoopStep);
    for (int i = 0; i < count; ++i) {
      const double now = kArmLoopStep * i;
      moveArm(now);
      if (i % kStepsPerSample == 0) exchange(now + kArmLoopStep);
      sum += std::pow(acting_ - tissueForce(place_), 2);
    }
    result_.error = std::sqrt(sum / count);
    return result_;
  }

 private:
  const ArmLoopSettings& settings_;
  const TeleopMapping& mapping_;
  const HandJoint& insertion_;
  const ToolLimits limits_ = wideLimits();
  TeleopState state_;
  TeleopInput input_;
  Way<ArmSample> measurements_;
  Way<double> forces_;
  Eigen::Vector3d axis_;
  ArmLoopResult result_;
  double place_ = 0, velocity_ = 0, acting_ = 0;  // of the hand, and the force on it
  double energy_ = 0, lowest_ = 0;                // given so far
  double allowed_ = 0, lowest_allowed_ = 0, last_news_ = -1, last_step_ = 0;

  double tissueForce(double place) const {
    return std::clamp(-settings_.stiffness * place, -insertion_.port.force_limit, insertion_.port.force_limit);
  }

  void moveArm(double now) {
    const double before = place_;
    place_ = settings_.hand(now, before, velocity_, acting_);
    energy_ += acting_ * (place_ - before);
    allowed_ += acting_ * (place_ - before);
    const PortState& port = state_.ports[Insertion];
    if (port.suspended > 0) allowed_ -= kArmLoopStep * insertion_.port.capacity / kReturnTime;
    lowest_ = std::min(lowest_, energy_);
    lowest_allowed_ = std::min(lowest_allowed_, allowed_);
    result_.most = std::max(result_.most, energy_ - lowest_);
    most_allowed_ = std::max(most_allowed_, allowed_ - lowest_allowed_);
    result_.beyond = most_allowed_ - insertion_.port.capacity;
  }
  double most_allowed_ = 0;

  void exchange(double now) {
    ArmSample sample;
    sample.time = now;
    const double step = insertion_.port.resolution;
    sample.position = axis_ * (step > 0 ? step * std::round(place_ / step) : place_);
    measurements_.send(now, sample);
    if (now - last_news_ >= kNews) hearTissue(now);
    while (measurements_.take(now, sample)) {
      const Lateness late = latenessOf(mapping_, now - sample.time);
      if (!late.key.empty()) result_.warnings.insert(late.key);
      input_.sample = sample;
      teleop(now);
    }
    if (now - last_step_ >= kForcePeriod) teleop(now);
    while (forces_.take(now, acting_)) {
    }
  }

  /// As the simulator has it: a spring about the place where the joint is now.
  void hearTissue(double now) {
    last_news_ = now;
    const double scale = insertion_.scale, joint = state_.joints[Insertion];
    TissueResponse tissue;
    tissue.time = now;
    JointSpring& spring = tissue.joints[Insertion];
    spring.position = joint;
    spring.stiffness = settings_.stiffness / (scale * scale * mapping_.force_scale);
    spring.effort = -spring.stiffness * joint;
    input_.tissue = tissue;
  }

  void teleop(double now) {
    const TeleopOutput output = step(mapping_, limits_, now, input_, state_);
    input_.sample.reset();
    input_.joints = state_.joints;
    last_step_ = now;
    if (output.sentence.find("fallen silent") != std::string::npos) result_.warnings.insert("silent");
    if (output.sentence.find("more than its 'energy'") != std::string::npos) result_.warnings.insert("overdrawn");
    if (output.withheld > kMissed) result_.warnings.insert("held back");
    forces_.send(now, axis_.dot(output.force));
  }
};

}  // namespace

HandAtArm swayingHand(double amplitude, double frequency) {
  return [=](double time, double place, double& velocity, double) {
    const double w = 2 * M_PI * frequency;
    velocity = std::clamp(amplitude * w * std::cos(w * time), -kHandSpeed, kHandSpeed);
    return place + kArmLoopStep * velocity;
  };
}

HandAtArm lightHand(double amplitude, double frequency) {
  constexpr double kMass = 0.1, kDamping = 1, kStiffness = 100;  // [kg], [N s/m], [N/m]
  return [=](double time, double place, double& velocity, double force) {
    const double intended = amplitude * std::sin(2 * M_PI * frequency * time);
    velocity += kArmLoopStep / kMass * (force - kDamping * velocity - kStiffness * (place - intended));
    velocity = std::clamp(velocity, -kHandSpeed, kHandSpeed);
    return place + kArmLoopStep * velocity;
  };
}

HandAtArm yieldingHand(double range) {
  constexpr double kTurn = 0.02;  // [s]
  return [=, direction = 1.0, turned = 0.0](double time, double place, double& velocity, double force) mutable {
    if ((force > 0) != (direction > 0) && time - turned > kTurn) direction = -direction, turned = time;
    velocity = kHandSpeed * direction;
    return std::clamp(place + kArmLoopStep * velocity, -range, range);
  };
}

ArmLoopResult runArmLoop(const ArmLoopSettings& settings) {
  return ArmLoop(settings).run();
}

}  // namespace vibe::hardware
