#include "trainee/operator.hpp"
#include "vibe_core/trainee/suture_pattern.hpp"

namespace vibe {

namespace {

constexpr double kLongestCinch = 20;  // [s]
constexpr double kStalled = 2;        // without a rise of the tension: no more thread comes [s]
constexpr double kRise = 0.01;        // that counts, of the full tension [1]

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

GoalResult perform(const SutureSetGoal& goal, Operator& me) {
  if (!me.view().needle_loaded) return {false, "there is no needle"};
  const AnatomicalMap& map = me.map();
  const WallPoint centre = find(goal.centre, map);
  std::vector<WallPoint> targets;
  for (const Eigen::Vector2d& place : suturePattern(goal.pattern, goal.bites, goal.length, goal.width))
    targets.push_back(map.walk(centre, place.x(), goal.mirrored ? -place.y() : place.y()));
  int taken = 0;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    me.say("bite " + std::to_string(k + 1) + " of " + std::to_string(targets.size()));
    if (takeBite(targets[k], me).reached) ++taken;
  }
  if (taken < 2) return {false, "only " + std::to_string(taken) + " bites could be taken"};
  if (goal.cinched) {
    me.say("T-tag and cinch");
    const GoalResult cinch = perform(CinchGoal{}, me);
    if (!cinch.reached) return cinch;
  }
  const std::string count = std::to_string(taken) + " of " + std::to_string(targets.size()) + " bites taken";
  return {taken == static_cast<int>(targets.size()), count};
}

}  // namespace vibe
