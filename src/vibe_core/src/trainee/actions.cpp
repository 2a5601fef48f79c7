#include <algorithm>
#include <cmath>

#include "trainee/bite_attempt.hpp"
#include "trainee/operator.hpp"
#include "trainee/picture.hpp"
#include "vibe_core/files/number_text.hpp"

namespace vibe {

namespace {

constexpr double kFirstInsertion = 0.06;  // [m]

}  // namespace

GoalResult perform(const InsufflateGoal& goal, Operator& me) {
  if (!me.model().scene.gas) return {false, "the scene has no gas; add 'gas: {}'"};
  if (me.hand.joints()[Insertion] < kFirstInsertion) me.hand.move(Insertion, kFirstInsertion, 1);
  me.hand.press(Insufflate);
  if (!me.hand.await([&] { return me.view().pressure_reached; }, goal.patience))
    return {false, "the pressure did not reach its set point"};
  return {true, ""};
}

GoalResult perform(const WithdrawGoal& goal, Operator& me) {
  stepBack(me);
  me.hand.move(Insertion, goal.insertion, 1);
  me.hand.release(Insufflate);
  me.hand.wait(0.5);
  return {true, ""};
}

GoalResult perform(const WaitGoal& goal, Operator& me) {
  me.hand.wait(goal.time);
  return {true, ""};
}

namespace {

constexpr double kHalfView = 0.87;     // 50 degrees; a gastroscope's picture is 140 degrees wide across its corners
constexpr double kFarthestView = 1.5;  // distance at which a place still counts as seen, of the wanted one

}  // namespace

GoalResult perform(const InspectGoal& goal, Operator& me) {
  const WallPoint target = find(goal.place, me.map());
  const std::array<double, kJointCount> joints = bestView(me.position(target), me.outward(target), goal.distance, me);
  if (!travel(joints, me)) return {false, "the scope met a wall on its way"};
  me.hand.wait(me.skill().reaction_time + goal.time);
  const View view = viewOf(me.position(target), me.view());
  const bool seen = view.angle < kHalfView && view.distance < kFarthestView * goal.distance;
  const std::string text = formatted("%s from %.0f mm, %.0f deg off the middle of the picture",
                                     seen ? "seen" : "the scope does not get the place into its picture: it is seen",
                                     1e3 * view.distance, view.angle * 180 / M_PI);
  return {seen, text};
}

namespace {

constexpr double kBeamGap = 3e-3;  // from the probe to the wall, and more of it with each try [m]
constexpr double kAimed = 2e-3;    // of the beam from its target, and of the probe from its distance [m]
constexpr int kCorrections = 3;    // of the tip, before the pedal is pressed

// Brings the probe before the wall; what the last motion missed is added to the next. Where a wall presses on the scope
// it stays as it is: a correction would press on.
bool approachMark(const WallPoint& target, double distance, Operator& me) {
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();
  for (int k = 0; k < kCorrections; ++k) {
    const Eigen::Vector3d place = me.position(target);
    const TraineeHand::Joints joints = bestView(place + correction, me.outward(target), distance, me);
    if (!travel(joints, me)) return false;
    me.hand.wait(me.skill().reaction_time + 0.1);
    const View view = viewOf(place, me.view());
    const Eigen::Vector3d miss =
        place - (me.view().tip + view.distance * (me.view().tip_turn * Eigen::Vector3d::UnitX()));
    if (miss.norm() < kAimed && std::abs(view.distance - distance) < kAimed) return true;
    if (me.hand.feelsMuch()) return true;
    correction += miss + (view.distance - distance) * me.outward(target);
  }
  return true;
}

bool burn(double time, Operator& me) {
  me.hand.forget();
  me.hand.hold(ApcPedal, time);
  me.hand.wait(me.skill().reaction_time);
  return me.hand.happened(Event::Kind::Mark);
}

}  // namespace

GoalResult perform(const MarkGoal& goal, Operator& me) {
  if (!me.model().scene.marking) return {false, "the scene has no argon beam; add 'marking: {}'"};
  const double probe = me.model().scene.marking->apc.probe_length;
  const WallPoint place = find(goal.place, me.map());
  GoalResult result{false, ""};
  for (int k = 0; k < me.skill().attempts && !result.reached; ++k) {
    if (k > 0) retreat(me);
    if (!approachMark(me.withAimError(place), probe + (1 + k) * kBeamGap, me))
      result.reason = "the scope met a wall on its way";
    else if (burn(goal.time, me))
      result = {true, ""};
    else
      result.reason = "the beam left no mark";
  }
  return result;
}

namespace {

constexpr double kNextTime = 0.5;  // part of a surprise that is expected of the next bite, beside the last; measured

}  // namespace

GoalResult takeBite(const WallPoint& target, Operator& me) {
  if (!me.model().scene.helix || !me.model().scene.suture)
    return {false, "the scene has no helix or no suture; add 'helix: {}' and 'suture: {}'"};
  GoalResult result;
  me.surprise *= kNextTime;
  me.tries = {};
  me.hand.wait(me.skill().look_time);
  for (int attempt = 0; attempt < me.skill().attempts; ++attempt) {
    result = BiteAttempt(target, attempt, me).make();
    if (result.reached) {
      ++me.bites_taken;
      return result;
    }
    me.say("try " + std::to_string(attempt + 1) + " of " + std::to_string(me.skill().attempts) + ": " + result.reason);
  }
  return result;
}

GoalResult perform(const BiteGoal& goal, Operator& me) {
  me.set = {};  // of a set that was cancelled
  return takeBite(find(goal.place, me.map()), me);
}

namespace {

constexpr double kLongestCinch = 20;  // [s]
constexpr double kStalled = 2;        // without a rise of the tension: no more thread comes [s]
constexpr double kRise = 0.01;        // that counts, of the full tension

bool isTight(const Operator& me) {
  const Observation& seen = me.view();
  if (seen.stage == Suture::Stage::Cinched || seen.stage == Suture::Stage::Broken) return true;
  return seen.tension >= me.skill().tightness * me.model().scene.suture->cinch_tension;
}

/// Notices that a thread that pulls becomes no tighter: the bites have met.
class Stall {
 public:
  explicit Stall(const Operator& me) : me_(me), scene_(*me.model().scene.suture) {}

  bool operator()() {
    const double tension = me_.view().tension;
    if (tension > max_ + kRise * scene_.cinch_tension) max_ = tension, risen_ = me_.view().time;
    return tension > scene_.loose_tension && me_.view().time - risen_ > kStalled;
  }

 private:
  const Operator& me_;
  const SutureScene& scene_;
  double max_ = 0, risen_ = 0;
};

}  // namespace

GoalResult perform(const CinchGoal&, Operator& me) {
  TraineeHand& hand = me.hand;
  hand.forget();
  hand.hold(TTag, 0.15);
  if (!hand.await([&] { return hand.happened(Event::Kind::TTagDropped); }, 1))
    return {false, "the T-tag could not be dropped"};
  stepBack(me);
  hand.press(Cinch);
  hand.wait(0.5);
  Stall stalled(me);
  const bool tight = hand.await([&] { return isTight(me) || stalled(); }, kLongestCinch);
  hand.release(Cinch);
  hand.wait(0.5);
  return tight ? GoalResult{true, ""} : GoalResult{false, "the thread did not become tight"};
}

}  // namespace vibe
