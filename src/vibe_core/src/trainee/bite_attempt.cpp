#include "trainee/bite_attempt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trainee/ik_solution.hpp"

namespace vibe {

namespace {

constexpr double kHelixOut = 26e-3;     // helix_advance while it is screwed in [m]
constexpr double kHelixHome = 2e-3;     // [m]
constexpr double kFullyDrawn = 1e-3;    // helix_advance at which the wall is in the device [m]
constexpr double kStandOff = 10e-3;     // gap between helix and wall before contact [m]
constexpr double kNear = 3e-3;          // gap within reach of the helix, with a margin [m]
constexpr double kInto = 1.5e-3;        // depth into the wall, so that it is surely in reach [m]
constexpr double kAside = 1.5e-3;       // of the helix from its aim along the wall, good enough [m]
constexpr double kArmClosed = 18e-3;    // needle_driver [m]
constexpr double kDeepEnough = 1.5;     // depth of the needle over the wall's thickness [1]
constexpr double kBesideTarget = 6e-3;  // of the needle from the target, to be tried again [m]
constexpr double kMorePerTry = 1e-3;    // with every further try that much more is accepted [m]
constexpr double kLearning = 0.7;       // weight of the present try in what is learned [1]
constexpr double kTurn = 6.283185307179586;
const Eigen::Vector3d kHelixInTip(kHelixOut - 2e-3, 2.8e-3, -2.2e-3);  // tip of the helix in scope_tip [m]

// Before anything has been seen: where the needle passes, from the helix, with the wall drawn in, in scope_tip [m].
const Eigen::Vector3d kNeedleFromHelix(0, -5.3e-3, 5e-3);

WallPoint withError(const WallPoint& target, Operator& me) {
  const Eigen::Vector2d error = me.nextAimError();
  return me.map().walk(target, error[0], error[1]);
}

Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - normal * normal.dot(v);
}

}  // namespace

BiteAttempt::BiteAttempt(const WallPoint& target, int number, Operator& me)
    : target_(withError(target, me)),
      number_(number),
      last_(number + 1 >= me.skill().attempts),
      me_(me),
      hand_(me.hand),
      aim_(target_) {}

GoalResult BiteAttempt::make() {
  GoalResult result{false, "the helix got no hold of the wall"};
  if (grab()) {
    result = drawAndClose();
    hand_.move(HelixAdvance, kHelixOut - 4e-3, 0.6);
  }
  letGo();
  if (result.reached) takeNeedleBack();
  return result;
}

void BiteAttempt::settle() {
  hand_.wait(me_.skill().reaction_time + 0.1);
}

// Of the helix from the wall.
double BiteAttempt::gap() const {
  double min = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : me_.view().wall) min = std::min(min, (p - me_.view().helix).squaredNorm());
  return std::sqrt(min);
}

// From the geometry of the device, before anything has been seen: along the wall, distal and anterior [m].
Eigen::Vector2d BiteAttempt::expectedNeedle() const {
  const Eigen::Vector3d outward = me_.outward(target_);
  const Hand::Joints joints = aimAt(me_.model(), me_.position(target_), outward, kHelixInTip, hand_.joints()).joints;
  std::vector<Eigen::Isometry3d> poses;
  me_.model().tool->forwardKinematics(joints, poses);
  const Eigen::Matrix3d tip = (me_.model().tool_base * poses[me_.model().tip_link]).linear();
  return me_.seen_map->alongWall(target_, tip * kNeedleFromHelix);
}

// The needle passes beside the helix, so the helix is to take hold beside the target.
void BiteAttempt::aimBesideTarget() {
  const AnatomicalMap& map = *me_.seen_map;
  const std::optional<Eigen::Vector2d> learned = me_.needleFromHelix(map.around(target_));
  const Eigen::Vector2d beside = learned ? *learned : expectedNeedle();
  aim_ = map.walk(target_, -beside[0], -beside[1]);
}

// Moves the helix to its aim at a depth below the mucosa; what the last motion missed is added to the next.
bool BiteAttempt::approach(double into, double min) {
  const Eigen::Vector3d outward = me_.outward(aim_), wanted = me_.position(aim_) + into * outward;
  Hand::Joints joints = aimAt(me_.model(), wanted + correction_, outward, kHelixInTip, hand_.joints()).joints;
  joints[HelixAdvance] = kHelixOut;
  const bool arrived = hand_.moveTo(joints, min, [this] { return hand_.feelsTooMuch(); });
  settle();
  const Eigen::Vector3d miss = wanted - me_.view().helix;
  correction_ += miss;
  aside_ = across(miss, outward).norm();
  return arrived;
}

bool BiteAttempt::grab() {
  aimBesideTarget();
  approach(-kStandOff, 0.5);
  for (const double into : {kInto, kInto, 2 * kInto, 2 * kInto, 3 * kInto, 4 * kInto}) {  // the wall yields
    if (!approach(into, 0.3)) break;
    if (gap() < kNear && aside_ < kAside) break;
  }
  hand_.press(HelixGrab);
  hand_.move(HelixRotation, me_.skill().turns * kTurn, 0.8);
  settle();
  return me_.view().grips;
}

bool BiteAttempt::isDeepEnough(const NeedleView& needle) const {
  return needle.depth >= kDeepEnough * needle.thickness;
}

// Draws the wall into the device until enough of it lies before the needle.
void BiteAttempt::drawIn() {
  if (!me_.skill().checks_depth) {
    hand_.move(HelixAdvance, me_.skill().drawn, 0.8);
    return settle();
  }
  hand_.move(HelixAdvance, kFullyDrawn, 1.5, [this] {
    const std::optional<NeedleView> needle = lookAtNeedle(me_.model(), me_.view());
    return needle && isDeepEnough(*needle);
  });
  settle();
}

// What is seen before the arm closes; empty: all is well.
std::optional<GoalResult> BiteAttempt::judgeView() {
  if (!me_.view().grips) return GoalResult{false, "the helix slipped"};
  const std::optional<NeedleView> needle = lookAtNeedle(me_.model(), me_.view());
  if (!needle) return GoalResult{false, "no tissue is before the needle"};
  const AnatomicalMap& map = *me_.seen_map;
  const Eigen::Vector3d miss = map.position(needle->where) - map.position(target_);
  const Eigen::Vector2d seen = map.alongWall(target_, map.position(needle->where) - map.position(aim_));
  const double around = map.around(target_);
  const Eigen::Vector2d before = me_.needleFromHelix(around).value_or(seen);
  me_.learnNeedle(around, before + kLearning * (seen - before));
  if (!me_.skill().checks_depth) return {};
  if (miss.norm() > kBesideTarget + number_ * kMorePerTry)
    return GoalResult{false, "the needle would pass beside its target"};
  return {};
}

GoalResult BiteAttempt::drawAndClose() {
  drawIn();
  if (const std::optional<GoalResult> bad = judgeView()) return *bad;
  return closeArm();
}

GoalResult BiteAttempt::closeArm() {
  hand_.forget();
  hand_.move(NeedleDriver, kArmClosed, 0.3);
  hand_.await([this] { return hand_.happened(Event::Kind::Pierced) || hand_.happened(Event::Kind::BiteMissed); }, 1);
  GoalResult result{false, "the needle met no tissue"};
  if (const Event* pierced = hand_.find(Event::Kind::Pierced)) {
    const bool deep = pierced->particle >= 0 && pierced->value >= me_.model().organ.thickness[pierced->particle];
    result.reason = "the needle went through a part of the wall only";
    if (deep || last_ || !me_.skill().checks_depth) result = exchange();
  }
  hand_.move(NeedleDriver, 0.0, 0.3);
  settle();
  return result;
}

GoalResult BiteAttempt::exchange() {
  hand_.hold(Needle, 0.12);
  if (!hand_.await([this] { return hand_.happened(Event::Kind::Bite); }, 1))
    return {false, "the exchange did not get the needle"};
  return {true, ""};
}

void BiteAttempt::letGo() {
  hand_.release(HelixGrab);
  Hand::Joints joints = hand_.joints();
  joints[HelixAdvance] = kHelixHome;
  joints[HelixRotation] = 0;
  joints[Insertion] = std::max(0.0, joints[Insertion] - 8e-3);
  hand_.moveTo(joints, 0.8);
  settle();
}

void BiteAttempt::takeNeedleBack() {
  for (int k = 0; k < 3 && me_.view().needle_loaded && !me_.view().needle_on_arm; ++k) {
    hand_.move(NeedleDriver, kArmClosed, 0.3);
    settle();
    hand_.hold(Needle, 0.12);
    settle();
    hand_.move(NeedleDriver, 0.0, 0.3);
    settle();
  }
}

}  // namespace vibe
