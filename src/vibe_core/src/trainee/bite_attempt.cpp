#include "trainee/bite_attempt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trainee/ik_solution.hpp"
#include "trainee/operator.hpp"
#include "trainee/picture.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kHelixHome = 2e-3;   // [m]
constexpr double kStandOff = 10e-3;   // gap between helix and wall before contact [m]
constexpr double kHelixReach = 3e-3;  // gap within reach of the helix, with a margin [m]
constexpr double kAside = 1.5e-3;     // of the helix from its aim along the wall, good enough [m]
constexpr double kArmClosed = 18e-3;  // needle_driver [m]
constexpr double kFold = 4e-3;        // a surprise that is learned fully; of larger ones that much [m]
constexpr int kWays = 3;              // that are tried to come to the wall, in each try
constexpr double kTurn = 6.283185307179586;

Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - normal * normal.dot(v);
}

}  // namespace

BiteAttempt::BiteAttempt(const WallPoint& target, int number, Operator& me)
    : target_(me.withAimError(target)),
      number_(number),
      last_(number + 1 >= me.skill().attempts),
      me_(me),
      hand_(me.hand) {}

GoalResult BiteAttempt::make() {
  GoalResult result;
  try {
    result = grabAndStitch();
  } catch (const Error& error) {  // the way along the wall to a place leaves the organ
    result = {false, error.what()};
  }
  letGo();
  if (result.reached) takeNeedleBack();
  return result;
}

GoalResult BiteAttempt::grabAndStitch() {
  if (!comeNear()) return {false, "the way to the wall is blocked"};
  if (!grab()) {
    me_.tries.failed.push_back({plan_.turn, kBlocked});
    return {false, "the helix got no hold of the wall"};
  }
  const GoalResult result = drawAndClose();
  hand_.move(HelixAdvance, kHelixOut - 4e-3, 0.6);
  return result;
}

void BiteAttempt::settle() {
  hand_.wait(me_.skill().reaction_time + 0.1);
}

// Moves the helix to its aim at a depth below the mucosa; what the last motion missed is added to the next.
bool BiteAttempt::approach(double into, double min) {
  const Eigen::Vector3d outward = me_.outward(plan_.held), wanted = me_.position(plan_.held) + into * outward;
  const TraineeHand::Joints joints =
      reachFor(me_.model(), wanted + correction_, helixInTip(kHelixOut), plan_.joints).joints;
  const bool arrived = hand_.feelTo(joints, min);
  settle();
  const Eigen::Vector3d miss = wanted - me_.view().helix;
  correction_ += miss;
  aside_ = across(miss, outward).norm();
  return arrived;
}

// Where something presses on the way, such as a fold of an earlier set, the scope comes anew from its entry, and
// another way.
bool BiteAttempt::comeNear() {
  if (hand_.feelsTooMuch()) retreat(me_);
  for (int k = 0; k < kWays; ++k) {
    plan_ = planBite(target_, me_);
    if (approach(-kStandOff, 0.5)) return true;
    me_.tries.failed.push_back({plan_.turn, kBlocked});
    retreat(me_);
    correction_.setZero();
  }
  return false;
}

bool BiteAttempt::grab() {
  // the scope gives way, so the device may lie otherwise than planned
  const BitePlan seen = planBiteFromHere(target_, me_);
  if (std::isfinite(seen.cost)) plan_.held = seen.held, plan_.drawn = seen.drawn;
  for (const double more : {1, 1, 2, 2, 3, 4}) {  // the wall yields
    if (!approach(more * kHelixDepth, 0.3)) break;
    if (distanceOfWall(me_.view().helix, me_.model(), me_.view()) < kHelixReach && aside_ < kAside) break;
  }
  before_ = me_.view();
  hand_.press(HelixGrab);
  hand_.move(HelixRotation, me_.skill().turns * kTurn, 0.8);
  settle();
  return me_.view().grips;
}

// How far from the helix the wall has followed, so that what is seen would have been imagined of the device as it lay
// when the helix took hold; and what the needle misses beyond that.
void BiteAttempt::learn(const NeedleView& needle) {
  const AnatomicalMap& map = *me_.seen_map;
  const WallPoint held = nearestOn(before_.helix, plan_.held, me_.model().organ.surface.triangles, before_.wall);
  const auto imaginedWith = [&](double follows) {
    const double from = before_.joints[HelixAdvance], drawn = me_.view().joints[HelixAdvance];
    return imagineNeedle(me_.model(), before_, {held, before_.tip_turn, from, drawn, follows});
  };
  double nearest = me_.follows, min = std::numeric_limits<double>::infinity();
  for (const double follows : {0.03, 0.05, 0.08, kFollowsFree}) {
    const std::optional<NeedleView> imagined = imaginedWith(follows);
    if (!imagined) continue;
    const double off =
        (map.position(needle.where) - map.position(imagined->where)).norm() + std::abs(needle.depth - imagined->depth);
    if (off < min) min = off, nearest = follows;
  }
  me_.follows = std::sqrt(me_.follows * nearest);
  const std::optional<NeedleView> imagined = imaginedWith(me_.follows);
  if (!imagined) return;
  const Eigen::Vector2d further = map.alongWall(target_, map.position(needle.where) - map.position(imagined->where));
  // a large one is of a fold, which will lie otherwise next time
  const double part = std::min(1.0, kFold / std::max(further.norm(), 1e-9));
  me_.surprise = me_.skill().foresight * part * further;
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
    const double share = last_ ? kHolds : 1;
    const bool deep =
        pierced->particle >= 0 && pierced->value >= share * me_.model().organ.thickness[pierced->particle];
    result.reason = "the needle went through a part of the wall only";
    const std::optional<GoalResult> beside = judgePlace();  // folds slip past the needle as the arm closes
    if (beside) result = *beside;
    if (!beside && (deep || !me_.skill().checks_depth)) result = exchange();
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
  TraineeHand::Joints joints = hand_.joints();
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
