// How a bite is drawn in: until the needle would go through the wall at its target, no farther than the wall comes.
#include <algorithm>
#include <cmath>
#include <string>

#include "trainee/bite_attempt.hpp"
#include "trainee/ik_solution.hpp"
#include "trainee/operator.hpp"
#include "trainee/picture.hpp"

namespace vibe {

namespace {

constexpr double kPushed = 10e-3;        // of the device towards the wall, where not enough of it comes [m]
constexpr double kDeepEnough = 1.5;      // depth of the needle over the wall's thickness
constexpr double kThrough = 1.15;        // the least with which an expert closes the arm
constexpr double kOnTarget = 2.5e-3;     // of the needle from the target, not to be improved [m]
constexpr double kBesideTarget = 5e-3;   // to be tried again [m]
constexpr double kDrawnPerTry = 1.5e-3;  // farther with every further try, by a trainee that does not check [m]
constexpr double kMorePerTry = 2e-3;     // with every further try that much more is accepted [m]
constexpr double kFarthest = 10e-3;      // but no more: half of the way from bite to bite in a U of seven [m]
// Design choices: what counts as no more than squeezing, and the margin to where the wall tore off or pulled too much.
constexpr double kInVain = 2e-3;     // of drawing that brings the needle no deeper [m]
constexpr double kGain = 0.2e-3;     // of depth that counts [m]
constexpr double kLessDrawn = 3e-3;  // [m]

/// Notices that drawing brings the needle no deeper: what fills the device is only squeezed, until the helix tears off.
class InVain {
 public:
  /// @param drawn  helix_advance [m]
  bool operator()(double depth, double drawn) {
    if (depth > deepest_ + kGain) deepest_ = depth, from_ = drawn;
    return from_ - drawn > kInVain;
  }

 private:
  double deepest_ = 0, from_ = 0;
};

std::string millimetres(double length) {
  return std::to_string(std::lround(1e3 * length)) + " mm";
}

}  // namespace

std::optional<NeedleView> BiteAttempt::look() const {
  return lookAtNeedle(me_.model(), me_.view());
}

double BiteAttempt::missOf(const NeedleView& needle) const {
  return (me_.seen_map->position(needle.where) - me_.seen_map->position(target_)).norm();
}

bool BiteAttempt::isGood(const NeedleView& needle) const {
  return needle.depth >= kThrough * needle.thickness && missOf(needle) < kOnTarget;
}

// Draws the wall into the device until the needle would go through all of it at the target, or as far as it comes.
void BiteAttempt::drawIn() {
  if (!me_.skill().checks_depth) {
    hand_.move(HelixAdvance, std::max(kFullyDrawn, me_.skill().drawn - number_ * kDrawnPerTry), 0.8);
    return settle();
  }
  InVain in_vain;
  const auto enough = [this, &in_vain] {
    const std::optional<NeedleView> needle = look();
    if (needle) remember(*needle);
    if (!me_.view().grips || pullsTooMuch()) return true;
    return needle && (isGood(*needle) || in_vain(needle->depth, me_.view().joints[HelixAdvance]));
  };
  hand_.move(HelixAdvance, plan_.drawn, 1.2, enough);
  settle();
  const double farthest = std::max(kFullyDrawn, me_.tries.least_drawn);
  if (!isDeep()) hand_.move(HelixAdvance, farthest, 0.6, [&] { return isDeep() || enough(); });
  settle();
  if (pullsTooMuch() || !me_.view().grips) me_.tries.least_drawn = hand_.joints()[HelixAdvance] + kLessDrawn;
  if (!letBackOut()) pushOn();
}

// Beyond what presses on the scope anyhow.
bool BiteAttempt::pullsTooMuch() const {
  return (me_.view().force - before_.force).norm() > me_.skill().force_limit;
}

double BiteAttempt::acceptedMiss() const {
  return std::min(kBesideTarget + number_ * kMorePerTry, kFarthest);
}

void BiteAttempt::remember(const NeedleView& needle) {
  if (needle.depth < kThrough * needle.thickness || missOf(needle) >= nearest_miss_) return;
  nearest_miss_ = missOf(needle);
  nearest_drawn_ = me_.view().joints[HelixAdvance];
}

// To where the needle was seen near its target, if it is not any more: folds pass by it as they are drawn in.
// @return whether it was so
bool BiteAttempt::letBackOut() {
  const std::optional<NeedleView> needle = look();
  if (!me_.view().grips || nearest_miss_ > acceptedMiss() || (needle && missOf(*needle) <= acceptedMiss()))
    return false;
  hand_.move(HelixAdvance, nearest_drawn_, 0.6);
  settle();
  return true;
}

bool BiteAttempt::isDeep() const {
  const std::optional<NeedleView> needle = look();
  return needle && needle->depth >= kDeepEnough * needle->thickness;
}

// Where the wall has not come far enough, the device goes to the wall.
void BiteAttempt::pushOn() {
  if (isDeep() || !me_.view().grips) return;
  std::vector<Eigen::Isometry3d> poses;
  me_.model().tool->forwardKinematics(hand_.joints(), poses);
  const Eigen::Isometry3d tip = me_.model().tool_base * poses[me_.model().tip_link];
  const TraineeHand::Joints joints =
      reachFor(me_.model(), tip * Eigen::Vector3d(kPushed, 0, 0), Eigen::Vector3d::Zero(), hand_.joints()).joints;
  hand_.feelTo(joints, 0.8, [this] { return isDeep(); });
  settle();
}

// The first try has taught what the second one does otherwise; after that, or where there was nothing to learn, the
// device is to come another way.
GoalResult BiteAttempt::failedBy(double miss, const std::string& reason) {
  if (number_ > 0 || miss >= kBlocked) me_.tries.failed.push_back({plan_.turn, miss});
  return {false, reason};
}

// Where the needle passes as it is seen now; empty: near enough to its target.
std::optional<GoalResult> BiteAttempt::judgePlace() {
  const std::optional<NeedleView> needle = look();
  if (!needle) return {};
  me_.tries.needle = needle->where;
  if (!me_.skill().checks_depth) return {};
  if (missOf(*needle) > acceptedMiss())
    return failedBy(missOf(*needle), "the needle would pass " + millimetres(missOf(*needle)) + " beside its target");
  if (!last_ && me_.set.isSpoiledBy(needle->where, *me_.seen_map))
    return failedBy(missOf(*needle), "the bites would not form the pattern");
  return {};
}

// What is seen before the arm closes; empty: all is well.
std::optional<GoalResult> BiteAttempt::judgeView() {
  if (!me_.view().grips) return failedBy(kBlocked, "the helix slipped");
  const std::optional<NeedleView> needle = look();
  if (!needle) return failedBy(kBlocked, "no tissue is before the needle");
  learn(*needle);
  if (const std::optional<GoalResult> bad = judgePlace()) return bad;
  if (!me_.skill().checks_depth) return {};
  if (needle->depth < (last_ ? kHolds : kThrough) * needle->thickness)
    return failedBy(kOnTarget, "the needle would go through a part of the wall only");
  return {};
}

}  // namespace vibe
