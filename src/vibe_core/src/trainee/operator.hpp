#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/simulation/wall_coverage.hpp"
#include "vibe_core/tool/tool_model.hpp"
#include "vibe_core/trainee/observation.hpp"
#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/skill.hpp"

namespace vibe {

/// Completed fraction of a movement at a fraction s in [0, 1] of its time: 10 s^3 - 15 s^4 + 6 s^5. This is the
/// straight movement with the least mean squared jerk between two rest positions, and close to human reaching: Flash &
/// Hogan 1985, J Neurosci 5(7):1688. The peak speed is 15/8 of the mean speed, at half time.
inline double minimumJerk(double s) {
  if (s <= 0) return 0;
  if (s >= 1) return 1;
  return s * s * s * (10 + s * (-15 + 6 * s));
}

/// Mean speeds of an experienced operator's hand per joint, design choice [m/s], [rad/s].
constexpr std::array<double, kJointCount> kHandSpeed{0.04, 1.2, 1.2, 1.2, 0.025, 12.5, 0.05};
constexpr double kPeakOverMean = 1.875;  ///< of the speed of a minimum-jerk movement (Flash & Hogan 1985)

/// Time of a motion of several joints at once, within the tool's speeds [s].
inline double durationOfMotion(const std::array<double, kJointCount>& from, const std::array<double, kJointCount>& to,
                               double pace, const std::array<JointLimits, kJointCount>& limits) {
  double time = 0;
  for (int j = 0; j < kJointCount; ++j) {
    const double way = std::abs(to[j] - from[j]);
    time = std::max({time, way / (pace * kHandSpeed[j]), kPeakOverMean * way / limits[j].velocity});
  }
  return time;
}

/// The hands of a trainee: elementary motions, each of which lasts some steps and perceives what happens meanwhile.
/// Calls return when the motion has ended.
class TraineeHand {
 public:
  using Joints = std::array<double, kJointCount>;

  /// @param next  ends the present step and returns when the next one has been perceived
  TraineeHand(const Model& model, const Skill& skill, std::function<void()> next);

  /// Called before the coroutine goes on.
  void perceive(const Observation& seen);

  const Model& model() const { return model_; }
  const Skill& skill() const { return skill_; }
  const Observation& view() const { return *view_; }
  const StepInput& command() const { return command_; }
  const Joints& joints() const { return command_.joints; }  ///< commanded

  void wait(double seconds);
  /// @return whether the condition became true in time
  bool await(const std::function<bool()>& condition, double patience);

  /// Moves joints to positions at hand speed, in at least `min` seconds at an experienced pace. Entries that are not
  /// finite stay.
  /// @param stop  ends the motion on its way where it becomes true; empty: never
  /// @return false if it was stopped
  bool moveTo(const Joints& joints, double min, const std::function<bool()>& stop = {});
  bool move(Joint joint, double position, double min, const std::function<bool()>& stop = {});
  /// The same, but slower the more it feels, and stopped where that is more than the skill allows.
  bool feelTo(const Joints& joints, double min, const std::function<bool()>& stop = {});
  /// What is felt is more than the skill allows. For `stop`.
  bool feelsTooMuch() const { return view_->force.norm() > skill_.force_limit; }

  /// It is pressed on so much that it goes on with care only.
  bool feelsMuch() const;

  void press(Button button) { command_.buttons[button] = 1; }
  void release(Button button) { command_.buttons[button] = 0; }
  void hold(Button button, double seconds);

  /// Events since the last forget().
  bool happened(Event::Kind kind) const { return find(kind) != nullptr; }
  const Event* find(Event::Kind kind) const;
  void forget() { events_.clear(); }

 private:
  bool follow(const Joints& joints, double min, const std::function<bool()>& stop, const std::function<double()>& rate);
  double carefulRate() const;

  const Model& model_;
  const Skill& skill_;
  std::function<void()> next_;
  const Observation* view_ = nullptr;
  StepInput command_;
  std::vector<Event> events_;
};

/// What the tries of one bite have shown, so that the next ones are others.
struct TriesOfBite {
  struct Way {
    Eigen::Quaterniond turn;  ///< orientation of scope_tip with which it was planned
    double miss;              ///< of the needle from its target; what was blocked counts as far [m]
  };
  std::vector<Way> failed{};
  double least_drawn = 0;  ///< helix_advance: drawn farther the wall tears off or pulls too much [m]
  WallPoint needle;        ///< where it would pass or has passed
};

/// The set that is being sewn.
struct SetInHand {
  Technique pattern = Technique::Other;
  std::vector<WallPoint> points{};  ///< bites taken, then the targets of those to come; what was given up is left out
  std::size_t next = 0;             ///< bite

  /// The set could be read as its pattern with the next bite at its target, but not, or hardly, with it at this place:
  /// earlier bites have missed as well.
  bool isSpoiledBy(const WallPoint& place, const AnatomicalMap& map) const;

  /// Where to take the next bite if it cannot be taken at its target: empty if the set is read as its pattern without
  /// it, or with none of the places beside the target; else that of these places with which it is read most clearly.
  std::optional<WallPoint> placeInstead(const AnatomicalMap& map) const;

 private:
  double marginOf(const std::vector<WallPoint>& bites, const AnatomicalMap& map) const;
};

/// What the actions of a trainee share: hands, knowledge of the organ, random errors, and how to say what is going on.
struct Operator {
  TraineeHand& hand;
  std::uint64_t random;                         ///< state of the generator of errors
  std::function<void(const std::string&)> say;  ///< what is being done

  const Model& model() const { return hand.model(); }
  const Skill& skill() const { return hand.skill(); }
  const Observation& view() const { return hand.view(); }

  /// The organ as it was when the trainee last looked at it while no thread held it. Places are found in this map;
  /// the points of the wall that are found there move with the tissue.
  const AnatomicalMap& map();
  std::shared_ptr<const AnatomicalMap> seen_map;           ///< empty: has not looked yet
  Eigen::Vector3d position(const WallPoint& point) const;  ///< now, in world [m]
  Eigen::Vector3d outward(const WallPoint& point) const;   ///< now

  /// How far from the helix the wall followed it in the last bites, see ImaginedDraw [m].
  double follows = 0.14;
  /// What the needle missed in the last bite beyond what had been imagined: distal, anterior [m].
  Eigen::Vector2d surprise = Eigen::Vector2d::Zero();

  /// What it has seen since it was first told to look everywhere; null: it was not.
  std::shared_ptr<WallCoverage> coverage{};

  int bites_taken = 0;                ///< for the present goal
  std::vector<WallPoint> stitches{};  ///< where bites of earlier sets are, whose threads hold the wall
  TriesOfBite tries{};                ///< of the present bite
  SetInHand set{};                    ///< empty in a bite of its own

  double nextNormal();
  /// What is really aimed at: a point of the wall beside the target, Skill::aim_error away in each direction. Nobody
  /// aims beside the organ: where the error leads out of it, the target itself.
  WallPoint withAimError(const WallPoint& target);
};

/// Adds to `coverage`, where there is one, what is seen now. To be called after each step.
void lookAround(Operator& me);

/// Point of the wall at a place, now.
WallPoint find(const Place& place, const AnatomicalMap& map);

// One file each. All return when the goal is reached or given up.
GoalResult perform(const InsufflateGoal& goal, Operator& me);
GoalResult perform(const InspectGoal& goal, Operator& me);
GoalResult perform(const SurveyGoal& goal, Operator& me);
GoalResult perform(const MarkGoal& goal, Operator& me);
GoalResult perform(const BiteGoal& goal, Operator& me);
GoalResult perform(const SutureSetGoal& goal, Operator& me);
GoalResult perform(const CinchGoal& goal, Operator& me);
GoalResult perform(const WithdrawGoal& goal, Operator& me);
GoalResult perform(const WaitGoal& goal, Operator& me);

/// A bite is no nearer than this to one of an earlier set, whose tight thread holds the wall there: half of what the
/// helix draws into the device, with a margin; design choice [m]
constexpr double kBesideThread = 8e-3;

/// The points of the wall of a set. Where one would be too near to a bite of an earlier set, the whole pattern moves
/// along the organ, no farther than helps and than half of its length: single points that moved would change its shape.
std::vector<WallPoint> targetsOf(const SutureSetGoal& goal, Operator& me);

/// One bite at a point of the wall.
GoalResult takeBite(const WallPoint& target, Operator& me);
/// The scope straight and near its entry, out of the way.
void stepBack(Operator& me);

/// Moves the scope to joint positions past the walls: directly if they are near, else straightened and drawn back into
/// the entry, turned, and forward from there. Where it meets a wall with more than Skill::force_limit it comes back.
/// @return whether it arrived
bool travel(const TraineeHand::Joints& joints, Operator& me);

/// Straightens the scope and draws it back into the entry, out of what presses on it.
void retreat(Operator& me);

}  // namespace vibe
