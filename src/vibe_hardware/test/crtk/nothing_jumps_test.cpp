// Two arms and another node drive one tool in turn, in random sequences: no joint moves by more than the hands do.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <random>

#include "gamepad/pads.hpp"
#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware::nothing_jumps_test {
namespace {

using Joints = std::array<double, kJointCount>;
constexpr double kTick = 5e-3;       // [s]
constexpr std::size_t kNewsAge = 4;  // ticks until an arm hears where the tool is
constexpr double kPatience = 0.7;    // the tool obeys another arm after so long a silence [s]

TeleopMapping mappingOf() {
  return parseTeleopMapping(
      "name: test\nhand: {away: -z, up: y}\njoints:\n"
      "  insertion: {along: x, scale: 1}\n  rotation: {about: x, scale: 1}\n"
      "  tip_up_down: {along: z, scale: 10 deg/cm}\n  tip_left_right: {along: y, scale: 10 deg/cm}\n"
      "device: {button: {topic: d}, joints: {helix_advance: {along: x, scale: 0.5}, helix_rotation: {about: x, scale: "
      "1}}}\n"
      "gripper: {joint: needle_driver, closed: 0 deg, open: 45 deg, at_closed: 18 mm, at_open: 0 mm}\n",
      "my_arm.yaml", toolLimits());
}

/// An arm in the hand of a person who moves, stops, presses, and whose driver does what drivers do.
struct Arm {
  explicit Arm(unsigned seed) : random(seed) { sample.position = {in(-0.1, 0.1), in(-0.1, 0.1), in(-0.1, 0.1)}; }

  std::mt19937 random;
  TeleopMapping mapping = mappingOf();
  TeleopState state = startTeleop(mapping, 0);
  TeleopInput input;
  TeleopOutput output;
  ArmSample sample;
  Eigen::Vector3d speed = Eigen::Vector3d::Zero(), spin = Eigen::Vector3d::Zero();
  double gripper = 0, gripper_speed = 0;     // [rad], [rad/s]
  double silent_until = 0, late = 0;         // [s]
  bool runs = true;                          // its node
  double way = 0, turn = 0, grip = 0;        // that the hand has moved since the last measurement
  std::deque<std::array<double, 3>> recent;  // of the last ticks
  Joints agreed{};  // what the hand had moved of each joint when that was last where the tool is

  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  bool happens(double per_second) { return in(0, 1) < per_second * kTick; }

  void live(double now, bool may_end) {
    if (happens(2)) {
      const bool rests = happens(100);
      speed = rests ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(in(-.1, .1), in(-.1, .1), in(-.1, .1));
      spin = rests ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(in(-1, 1), in(-1, 1), in(-1, 1));
      gripper_speed = rests ? 0 : in(-2, 2);
    }
    sample.position += kTick * speed;
    if (spin.norm() > 0)
      sample.orientation = Eigen::AngleAxisd(kTick * spin.norm(), spin.normalized()) * sample.orientation;
    const double before = gripper;
    gripper = std::clamp(gripper + kTick * gripper_speed, -0.1, 0.9);
    way += kTick * speed.norm(), turn += kTick * spin.norm(), grip += std::abs(gripper - before);
    if (happens(0.5)) input.clutch = !input.clutch;
    if (happens(0.5)) input.device = !input.device;
    if (happens(0.3) || !input.ready) input.ready = !input.ready || happens(20);
    if (happens(0.2)) silent_until = now + in(0, 0.5);
    if (happens(0.2)) late = late > 0 ? 0 : in(0, 0.08);
    if (happens(0.2)) sample.position.x() += happens(100) ? 0.2 : -0.2;  // the driver finds another frame
    if (happens(0.2)) gripper += gripper > 0.4 ? -0.45 : 0.45;           // its encoder jumps
    if (may_end && happens(0.2)) runs = !runs, state = startTeleop(mapping, now);
    recent.push_back({way, turn, grip});
    if (recent.size() > 100) recent.pop_front();
  }

  void step(double now, const Joints& news) {
    input.joints = news;
    input.live = true;
    input.gripper = gripper;
    input.sample.reset();
    if (now > silent_until && in(0, 1) < 0.9) {
      sample.time = now - late * in(0.9, 1);
      input.sample = sample;
    }
    output = hardware::step(mapping, toolLimits(), now, input, state);
  }
  /// What the hand has moved of a joint until so many ticks ago.
  double moved(std::size_t joint, std::size_t ticks) const {
    const auto& then = recent[recent.size() - std::min(ticks, recent.size())];
    if (joint == NeedleDriver) return then[2] * 0.018 / (M_PI / 4);
    const HandJoint& map = mapping.joints[joint];
    // twist and swing of a hand that is tilted turn faster than the hand, by 1 / cos(swing / 2)
    return std::abs(map.scale) * (map.coordinate < HandRoll ? then[0] : 6 * then[1]);
  }
  /// @return motion of a joint at once beyond what the hand has moved since it was last where the tool is
  double beyond(std::size_t joint, double tool) {
    const double apart = std::abs(output.joints[joint] - tool), now = moved(joint, 1);
    const double jump = apart - (now - agreed[joint]);
    if (apart < unnoticed(static_cast<int>(joint))) agreed[joint] = moved(joint, 40);  // measurements may be late
    return jump;
  }
};

/// @return largest motion of a joint at once beyond what hands moved, in units of 1 mm or 1 degree
double play(unsigned seed, bool news_come) {
  std::array<Arm, 2> arms{Arm(seed), Arm(seed + 100000)};
  std::mt19937 random(seed);
  Joints tool{0.1, 0, 0, 0, 0.01, 0, 0.009}, aim = tool;
  std::deque<Joints> news(kNewsAge, tool);
  std::size_t owner = 0;
  double heard = 0, taken = 0, largest = 0, other_until = 0;
  for (double now = kTick; now < 6; now += kTick) {
    news.push_back(tool), news.pop_front();
    if (std::uniform_real_distribution<double>(0, 1)(random) < 0.2 * kTick) {  // another node moves the tool
      other_until = now + 0.5;
      for (std::size_t j = 0; j < tool.size(); ++j)
        aim[j] = std::uniform_real_distribution<double>(0, 1)(random) * std::min(0.3, toolLimits()[j].upper);
    }
    for (std::size_t j = 0; j < tool.size() && now < other_until; ++j) tool[j] += 0.05 * (aim[j] - tool[j]);
    if (now < other_until) owner = arms.size(), heard = now;
    for (std::size_t a = 0; a < arms.size(); ++a) {
      Arm& arm = arms[a];
      arm.live(now, true);
      if (!arm.runs) continue;
      arm.step(now, news_come ? news.front() : Joints{0.1, 0, 0, 0, 0.01, 0, 0.009});
      const bool obeyed = arm.output.engaged && now >= other_until && (owner == a || now - heard > kPatience);
      if (obeyed && (owner != a || now - heard > kPatience)) taken = now;
      for (std::size_t j = 0; j < tool.size(); ++j) {
        const double unit = j == Insertion || j == HelixAdvance || j == NeedleDriver ? 1e-3 : M_PI / 180;
        const double jump = arm.beyond(j, tool[j]);
        // until it hears that the tool obeys, an arm may just be giving way
        const bool hears = now - taken < kTick || now - taken > (kNewsAge + 1) * kTick;
        if (obeyed && hears) largest = std::max(largest, jump / unit);
      }
      if (!obeyed) continue;
      owner = a, heard = now;
      tool = arm.output.joints;
    }
  }
  return largest;
}

TEST(NothingJumps, InRandomSequencesOfTwoArmsAndAnotherNode) {
  double largest = 0;
  int controls = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    const double jump = play(seed, true);
    EXPECT_LE(jump, 1) << "seed " << seed;
    largest = std::max(largest, jump);
    if (seed <= 50) controls += play(seed, false) > 1 ? 1 : 0;
  }
  std::printf("largest motion beyond the hand's: %.2f mm or degrees; without news of the tool %d of 50 jump\n", largest,
              controls);
  EXPECT_GT(controls, 25);  // negative control
}

}  // namespace
}  // namespace vibe::hardware::nothing_jumps_test
