#include <algorithm>
#include <cmath>
#include <limits>

#include "trainee/ik_solution.hpp"
#include "trainee/operator.hpp"

namespace vibe {

namespace {

constexpr double kHelixOut = 26e-3;   // helix_advance while it is screwed in [m]
constexpr double kHelixHome = 2e-3;   // [m]
constexpr double kStandOff = 10e-3;   // gap between helix and wall before contact [m]
constexpr double kNear = 3e-3;        // gap within reach of the helix, with a margin [m]
constexpr double kInto = 1.5e-3;      // depth into the wall, so that it is surely in reach [m]
constexpr double kAside = 1.5e-3;     // of the helix from its target along the wall, good enough [m]
constexpr double kArmClosed = 18e-3;  // needle_driver [m]
constexpr double kTurn = 6.283185307179586;
const Eigen::Vector3d kHelixInTip(kHelixOut - 2e-3, 2.8e-3, -2.2e-3);  // tip of the helix in scope_tip [m]

/// One attempt at a bite.
class BiteAttempt {
 public:
  BiteAttempt(const WallPoint& target, bool last, Operator& me)
      : target_(target), last_(last), me_(me), hand_(me.hand), error_(me.nextAimError()) {}

  GoalResult make() {
    GoalResult result{false, "the helix got no hold of the wall"};
    if (grab()) {
      result = closeOverTissue();
      hand_.move(HelixAdvance, kHelixOut - 4e-3, 0.6);
    }
    letGo();
    if (result.reached) takeNeedleBack();
    return result;
  }

 private:
  void settle() { hand_.wait(me_.skill().reaction_time + 0.1); }

  // Of the wall, with the aim error along it.
  Eigen::Vector3d aimedAt(Eigen::Vector3d& outward) const {
    const AnatomicalMap map = me_.lookAround();
    outward = map.outward(target_);
    const WallPoint aimed = map.walk(target_, error_[0], error_[1]);
    return map.position(aimed);
  }

  double gap() const {
    double min = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& p : me_.view().wall) min = std::min(min, (p - me_.view().helix).squaredNorm());
    return std::sqrt(min);
  }

  // Moves the helix to the target at a depth below the mucosa; what the last motion missed is added to the next.
  bool approach(double into, double min) {
    Eigen::Vector3d outward;
    const Eigen::Vector3d wanted = aimedAt(outward) + into * outward;
    Hand::Joints joints = aimAt(me_.model(), wanted + correction_, outward, kHelixInTip, hand_.joints()).joints;
    joints[HelixAdvance] = kHelixOut;
    const bool arrived = hand_.moveTo(joints, min, me_.skill().force_limit);
    settle();
    const Eigen::Vector3d miss = wanted - me_.view().helix;
    correction_ += miss - outward * outward.dot(miss);
    aside_ = (miss - outward * outward.dot(miss)).norm();
    return arrived;
  }

  bool grab() {
    approach(-kStandOff, 0.5);
    for (const double into : {kInto, kInto, 2 * kInto, 3 * kInto, 4 * kInto}) {  // the wall yields
      if (!approach(into, 0.3)) break;
      if (gap() < kNear && aside_ < kAside) break;
    }
    hand_.press(HelixGrab);
    hand_.move(HelixRotation, me_.skill().turns * kTurn, 0.8);
    settle();
    return me_.view().grips;
  }

  GoalResult closeOverTissue() {
    const double drawn = me_.skill().drawn;
    GoalResult result = closeArmAt(drawn, last_ && !me_.skill().checks_depth);
    if (!result.reached && me_.skill().checks_depth) result = closeArmAt(0.2 * drawn, last_);
    return result;
  }

  bool deepEnough(const Event& pierced) const {
    return pierced.particle >= 0 && pierced.value >= me_.model().organ.thickness[pierced.particle];
  }

  GoalResult closeArmAt(double drawn, bool accept) {
    hand_.move(HelixAdvance, drawn, 0.8);
    settle();
    if (!me_.view().grips) return {false, "the helix slipped"};
    hand_.forget();
    hand_.move(NeedleDriver, kArmClosed, 0.3);
    hand_.await([this] { return hand_.happened(Event::Kind::Pierced) || hand_.happened(Event::Kind::BiteMissed); }, 1);
    GoalResult result{false, "the needle met no tissue"};
    const Event* pierced = hand_.find(Event::Kind::Pierced);
    if (pierced != nullptr) {
      result.reason = "the needle went through a part of the wall only";
      if (accept || deepEnough(*pierced) || !me_.skill().checks_depth) result = exchange();
    }
    hand_.move(NeedleDriver, 0.0, 0.3);
    settle();
    return result;
  }

  GoalResult exchange() {
    hand_.hold(Needle, 0.12);
    if (!hand_.await([this] { return hand_.happened(Event::Kind::Bite); }, 1))
      return {false, "the exchange did not get the needle"};
    return {true, ""};
  }

  void letGo() {
    hand_.release(HelixGrab);
    Hand::Joints joints = hand_.joints();
    joints[HelixAdvance] = kHelixHome;
    joints[HelixRotation] = 0;
    joints[Insertion] = std::max(0.0, joints[Insertion] - 8e-3);
    hand_.moveTo(joints, 0.8);
    settle();
  }

  void takeNeedleBack() {
    for (int k = 0; k < 3 && me_.view().needle_loaded && !me_.view().needle_on_arm; ++k) {
      hand_.move(NeedleDriver, kArmClosed, 0.3);
      settle();
      hand_.hold(Needle, 0.12);
      settle();
      hand_.move(NeedleDriver, 0.0, 0.3);
      settle();
    }
  }

  const WallPoint target_;
  const bool last_;
  Operator& me_;
  Hand& hand_;
  const Eigen::Vector2d error_;  // of aim, along the wall [m]
  Eigen::Vector3d correction_ = Eigen::Vector3d::Zero();
  double aside_ = 1;
};

}  // namespace

GoalResult takeBite(const WallPoint& target, Operator& me) {
  GoalResult result;
  for (int attempt = 1; attempt <= me.skill().attempts; ++attempt) {
    result = BiteAttempt(target, attempt == me.skill().attempts, me).make();
    if (result.reached) return result;
    me.say("try " + std::to_string(attempt) + " of " + std::to_string(me.skill().attempts) + ": " + result.reason);
  }
  return result;
}

GoalResult perform(const BiteGoal& goal, Operator& me) {
  return takeBite(find(goal.place, me.lookAround()), me);
}

}  // namespace vibe
