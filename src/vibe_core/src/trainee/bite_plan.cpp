#include "trainee/bite_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "arithmetic/turn.hpp"
#include "trainee/ik_solution.hpp"
#include "trainee/picture.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr int kRolls = 12;                               // positions of the device around its axis that are considered
constexpr int kAimingRounds = 4;                         // of aiming beside the target
constexpr double kDrawn[] = {14e-3, 10e-3, 6e-3, 2e-3};  // helix_advance at the end that is considered [m]
constexpr double kBeside = 2e-3;                         // variations of a plan: of the place of the helix [m]
constexpr double kLessFollows = 0.4;                     // and of ImaginedDraw::follows
constexpr double kLost = 20e-3;                          // counts as the miss of a needle that meets nothing [m]
constexpr double kStep = 0.8;                            // part of a miss that is corrected per round
constexpr double kGoodDepth = 4.5e-3;                    // of the needle, where more is not better [m]
// Costs, per metre or radian; design choice: a millimetre beside the target against one of depth, of the device's arm
// that presses into the wall, and of half a radian of motion.
constexpr double kMissCost = 1e3, kShallowCost = 2e3, kPressCost = 0.5e3, kMotionCost = 1.5;
constexpr double kHindranceCost = 1e8;  // per cubic metre of wall in the way: 0.01 mL count as a millimetre
constexpr double kThreadCost = 0.5e3;   // per metre that the helix is too near to a bite of an earlier set
constexpr double kOtherWay = 0.8;       // of the device, turned by so much it is another way; design choice [rad]
constexpr double kAtTarget = 30e-3;     // along the wall, where the tip with its device is to lie at the wall [m]

// Where the closed arm's needle passes, from the drawn-in helix, in scope_tip [m].
const Eigen::Vector3d kNeedleFromHelix(0, -5.3e-3, 5e-3);

Eigen::Quaterniond turnOf(const Model& model, const TraineeHand::Joints& joints) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(joints, poses);
  return Eigen::Quaterniond((model.tool_base * poses[model.tip_link]).linear());
}

class Planner {
 public:
  Planner(const WallPoint& target, Operator& me) : target_(target), me_(me), map_(*me.seen_map) {}

  /// Of the device as it lies.
  BitePlan fromHere() const { return onTheOrgan(sought(me_.view().tip_turn, target_), me_.view().tip_turn); }

  /// @param least  of infinite cost, or without its uncertainty, where it would not cost less than this
  BitePlan withRoll(const TraineeHand::Joints& rolled, double least) const {
    const Eigen::Quaterniond about = turnOf(me_.model(), rolled);
    const BitePlan first = onTheOrgan(sought(about, target_), about);
    if (!std::isfinite(first.cost)) return first;
    const IkSolution reached = reachHeld(first.held, rolled);
    const Eigen::Quaterniond turn = turnOf(me_.model(), reached.joints);
    const auto withWay = [&](double cost, double in_the_way) {
      cost += kMissCost * (reached.miss + failed(turn)) + kHindranceCost * in_the_way;
      for (int j = Rotation; j <= TipLeftRight; ++j)
        cost += kMotionCost * std::abs(reached.joints[j] - me_.hand.joints()[j]);
      return cost;
    };
    if (withWay(0, 0) >= least) return {};
    BitePlan plan = sought(turn, first.held);
    if (withWay(plan.cost, 0) >= least) return {};
    plan.joints = reached.joints;
    plan.in_the_way = inTheWay(plan.joints);
    if (withWay(plan.cost, plan.in_the_way) < least) plan.cost += kMissCost * uncertainty(plan, turn);
    plan.cost = withWay(plan.cost, plan.in_the_way);
    plan.turn = turn;
    plan.held = foreseen(plan.held, turn);
    return plan;
  }

  /// Of infinite cost where a way along the wall leaves the organ.
  BitePlan withRollOnTheOrgan(const TraineeHand::Joints& rolled, double least) const {
    try {
      return withRoll(rolled, least);
    } catch (const Error&) {
      return {};
    }
  }

  /// Straight before the wall where the scope has room there, else as it comes best.
  BitePlan anyWay() const {
    const Eigen::Vector3d at = me_.position(target_), outward = me_.outward(target_);
    BitePlan best = anyRoll(outward, std::numeric_limits<double>::infinity());
    if (best.in_the_way < kRoomy || me_.skill().foresight <= 0) return best;
    for (const Eigen::Vector3d& ahead : obliqueWays(at, outward, me_.model())) {
      const BitePlan plan = anyRoll(ahead, best.cost);
      if (plan.cost < best.cost) best = plan;
    }
    return best;
  }

 private:
  /// @param ahead  direction of the tip's axis
  /// @param least  what costs no less is not wanted
  BitePlan anyRoll(const Eigen::Vector3d& ahead, double least) const {
    const Eigen::Vector3d at = me_.position(target_);
    TraineeHand::Joints joints = aimAt(me_.model(), at, ahead, helixInTip(kHelixOut), me_.hand.joints()).joints;
    joints[HelixAdvance] = kHelixOut;
    BitePlan best;
    const int considered = 1 + static_cast<int>(std::lround(me_.skill().foresight * (kRolls - 1)));
    for (int k = 0; k < considered; ++k) {  // 0, 1, -1, 2, ...
      const auto one = rolled(me_.model(), joints, 2 * M_PI * (k % 2 == 1 ? k / 2 + 1 : -k / 2) / kRolls);
      if (!one) continue;
      const BitePlan plan = withRollOnTheOrgan(*one, std::min(least, best.cost));
      if (plan.cost < best.cost) best = plan;
      me_.hand.wait(me_.model().scene.step_period);  // one turn per step: all at once would stop a real-time session
    }
    if (!std::isfinite(best.cost)) best.held = target_, best.joints = joints;
    return best;
  }

  /// What tries missed with about this orientation, although they had learned from the one before [m].
  double failed(const Eigen::Quaterniond& turn) const {
    double max = 0;
    for (const TriesOfBite::Way& way : me_.tries.failed)
      max = std::max(max, way.miss * (1 - angleBetween(turn, way.turn) / kOtherWay));
    return max;
  }

  /// How far it is too near to where threads of earlier sets hold the wall [m].
  double onThread(const WallPoint& held) const {
    double near = kBesideThread;
    for (const WallPoint& stitch : me_.stitches)
      near = std::min(near, (map_.position(held) - map_.position(stitch)).norm());
    return kBesideThread - near;
  }

  double inTheWay(const TraineeHand::Joints& joints) const {
    const Eigen::Vector3d target = map_.position(target_);
    return overlapWithWall(me_.model(), me_.view().wall, joints,
                           [&](int particle) { return (map_.vertices()[particle] - target).norm() < kAtTarget; });
  }

  /// Where to take hold with the tip in an orientation, and how far to draw the wall in: as little as gives depth. A
  /// needle that goes through the middle of a narrow fold may come out on either side of it.
  BitePlan sought(const Eigen::Quaterniond& turn, const WallPoint& held) const {
    BitePlan best;
    for (const double drawn : kDrawn) {
      if (drawn < me_.tries.least_drawn && std::isfinite(best.cost)) break;
      const BitePlan plan = soughtWith(drawn, turn, held);
      if (plan.cost < best.cost) best = plan;
      if (plan.depth >= kGoodDepth && plan.cost <= best.cost) break;
    }
    return best;
  }

  BitePlan soughtWith(double drawn, const Eigen::Quaterniond& turn, WallPoint held) const {
    BitePlan best;
    for (int round = 0; round < kAimingRounds; ++round) {
      const std::optional<NeedleView> needle =
          imagineNeedle(me_.model(), me_.view(), {held, turn, kHelixOut, drawn, me_.follows});
      if (!needle) break;
      const Eigen::Vector2d miss = missOf(*needle);
      const double cost = costOf(held, turn, miss.norm(), *needle);
      if (cost < best.cost) best = {held, {}, drawn, miss.norm(), needle->depth, cost, turn, 0};
      held = map_.walk(held, -kStep * miss[0], -kStep * miss[1]);
    }
    return best;
  }

  /// With the place as it is foreseen.
  /// @throws Error if the organ ends beside it
  BitePlan onTheOrgan(BitePlan plan, const Eigen::Quaterniond& turn) const {
    if (!std::isfinite(plan.cost)) return plan;
    placesBeside(plan.held);
    plan.held = foreseen(plan.held, turn);
    return plan;
  }

  /// Between where the needle is beside the helix as the device looks now, and a place that is right with foresight.
  WallPoint foreseen(const WallPoint& right, const Eigen::Quaterniond& turn) const {
    const double part = me_.skill().foresight;
    if (part >= 1) return right;
    const Eigen::Vector2d beside = -map_.alongWall(target_, turn * kNeedleFromHelix);
    const Eigen::Vector2d there = map_.alongWall(target_, map_.position(right) - map_.position(target_));
    const Eigen::Vector2d place = beside + part * (there - beside);
    return map_.walk(target_, place[0], place[1]);
  }

  /// How much farther from the target the needle would pass, in the mean, if the helix took hold a little beside or
  /// less of the wall followed: large among folds [m].
  double uncertainty(const BitePlan& plan, const Eigen::Quaterniond& turn) const {
    double sum = 0;
    int count = 0;
    const auto add = [&](const ImaginedDraw& draw) {
      const std::optional<NeedleView> needle = imagineNeedle(me_.model(), me_.view(), draw);
      sum += std::max(0.0, (needle ? missOf(*needle).norm() : kLost) - plan.miss);
      ++count;
    };
    for (const WallPoint& held : placesBeside(plan.held)) add({held, turn, kHelixOut, plan.drawn, me_.follows});
    add({plan.held, turn, kHelixOut, plan.drawn, kLessFollows * me_.follows});
    return sum / count;
  }

  std::array<WallPoint, 4> placesBeside(const WallPoint& held) const {
    return {map_.walk(held, kBeside, 0), map_.walk(held, -kBeside, 0), map_.walk(held, 0, kBeside),
            map_.walk(held, 0, -kBeside)};
  }

  /// Of a needle from the target, distal and anterior [m].
  Eigen::Vector2d missOf(const NeedleView& needle) const {
    return map_.alongWall(target_, map_.position(needle.where) - map_.position(target_)) + me_.surprise;
  }

  double costOf(const WallPoint& held, const Eigen::Quaterniond& turn, double miss, const NeedleView& needle) const {
    // of the open arm beyond the wall where the helix takes hold
    const Eigen::Vector3d arm = turn * (openNeedleInTip() - helixInTip(kHelixOut));
    const double pressed = std::max(0.0, arm.dot(needle.outward));
    return kMissCost * miss + kThreadCost * onThread(held) + kShallowCost * std::max(0.0, kGoodDepth - needle.depth) +
           kPressCost * pressed;
  }

  IkSolution reachHeld(const WallPoint& held, const TraineeHand::Joints& start) const {
    return reachFor(me_.model(), me_.position(held) + kHelixDepth * me_.outward(held), helixInTip(kHelixOut), start);
  }

  const WallPoint target_;
  Operator& me_;
  const AnatomicalMap& map_;
};

}  // namespace

BitePlan planBite(const WallPoint& target, Operator& me) {
  return Planner(target, me).anyWay();
}

BitePlan planBiteFromHere(const WallPoint& target, Operator& me) {
  return Planner(target, me).fromHere();
}

}  // namespace vibe
