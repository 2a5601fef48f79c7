// Hard cases in which the tool does it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact/bench_tools.hpp"
#include "contact/hard_cases.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kRam = 0.06;                      // deeper than at first contact [m]
constexpr double kWithdraw = 0.1;                  // speed [m/s]
constexpr double kTurns = 20;                      // of the helix
constexpr double kWindPull = 0.06;                 // [m]
constexpr double kAdvanceStep = 5e-4;              // of the helix in the search for the wall [m]
constexpr double kWindReach = 8e-3;                // of it, so that it takes hold on coarse meshes too [m]
constexpr double kLeastReach = 4e-3;               // of the helix, where it jumps [m]
constexpr double kJumpTime = 0.2;                  // between jumps [s]
constexpr double kSleeveTension = 8;               // [N]
constexpr double kSleeveSpeed = 0.06;              // of the cinch [m/s]
constexpr double kSleeveWidth = 0.085;             // half, along the wall: beyond the scope [m]
constexpr double kSleeveLength = 0.15;             // over the length of the body; half of it where there are three
constexpr double kSleeveTime = 8;                  // of a cinch [s]
constexpr double kShortest = 0.3, kLongest = 1.5;  // time of a random motion [s]
constexpr double kPressProbability = 0.3;          // probability that a button changes with a motion

/// From one command to another, all joints in the same time.
HardPhase move(const std::string& name, double duration, const StepInput& from, const StepInput& to) {
  return phaseOf(name, duration,
                 [from, to, duration](double end) { return between(from, to, std::clamp(end / duration, 0.0, 1.0)); });
}

/// Joints that go from one random place to the next, with smooth speeds within the limits, and buttons that change.
class RandomDrive {
 public:
  RandomDrive(const ToolModel& tool, const StepInput& start, std::uint64_t seed)
      : limits_(tool.limits()), random_(seed), from_(start), to_(start) {}

  StepInput at(double time) {
    while (time >= end_) choose();
    const double part = std::clamp((time - begin_) / (end_ - begin_), 0.0, 1.0);
    const double smooth = part * part * (3 - 2 * part);
    return between(from_, to_, smooth);
  }

 private:
  void choose() {
    from_ = to_;
    begin_ = end_;
    double duration = kShortest + (kLongest - kShortest) * nextUniform(random_);
    for (std::size_t j = 0; j < limits_.size(); ++j) {
      const double place = limits_[j].lower + (limits_[j].upper - limits_[j].lower) * nextUniform(random_);
      // the largest speed of the motion is 1.5 times its mean
      const double farthest = limits_[j].velocity * duration / 1.5;
      to_.joints[j] = from_.joints[j] + std::clamp(place - from_.joints[j], -farthest, farthest);
    }
    for (const Button button : {HelixGrab, Needle, TTag, Cinch})
      if (nextUniform(random_) < kPressProbability) to_.buttons[button] ^= 1;
    end_ = begin_ + duration;
  }

  std::array<JointLimits, kJointCount> limits_;
  std::uint64_t random_;
  StepInput from_, to_;
  double begin_ = 0, end_ = 0;
};

double helixGap(const Model& model, const State& state) {
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(state.joints, state.tool_displacement, poses);
  const Eigen::Vector3d tip = model.tool_base * poses[static_cast<std::size_t>(model.helix_link)].translation();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < state.x.size(); ++i)
    nearest = std::min(nearest, (Eigen::Vector3d(state.x[i], state.y[i], state.z[i]) - tip).norm());
  return nearest;
}

/// How far the helix has to be advanced to be nearest to a particle.
double bestAdvance(const Model& model, State state) {
  double best = 0, nearest = std::numeric_limits<double>::infinity();
  const double farthest = model.tool->limits()[HelixAdvance].upper;
  for (double advance = 0; advance <= farthest; advance += kAdvanceStep) {
    state.joints[HelixAdvance] = advance;
    const double gap = helixGap(model, state);
    if (gap < nearest) nearest = gap, best = advance;
  }
  return best;
}

}  // namespace

HardCase HardCases::ram(double speed) const {
  HardCase hard = begin();
  JointLimits limits = model_->tool->limits()[Insertion];
  limits.velocity = std::max(limits.velocity, 1.01 * speed);
  hard.model = modelWith(model_->scene, withJointLimits(urdf_, "insertion", limits), *model_);
  const double touching = insertionAtContact(hard.model, hard.start);
  startClock(hard.start);
  const StepInput near = holdAt(hard.start);
  StepInput deep = near;
  deep.joints[Insertion] = std::min(limits.upper, touching + kRam);
  const double way = deep.joints[Insertion] - near.joints[Insertion];
  hard.phases.push_back(move("ram", way / speed, near, deep));
  hard.phases.push_back(still("hold", 0.5, deep));
  hard.phases.push_back(move("withdraw", way / kWithdraw, deep, near));
  hard.phases.push_back(still("rest", brief_ ? 1 : 3, near));
  return hard;
}

HardCase HardCases::random(std::uint64_t seed) const {
  HardCase hard = begin();
  const StepInput start = holdAt(hard.start);
  const auto drive = std::make_shared<RandomDrive>(*model_->tool, start, seed);
  const double duration = brief_ ? 5 : 30;
  hard.phases.push_back(phaseOf("random", duration, [drive](double end) { return drive->at(end); }));
  const auto release = [drive, start, duration](double) {
    StepInput input = drive->at(duration);
    input.buttons = start.buttons;
    return input;
  };
  hard.phases.push_back(phaseOf("release", 0.25, release));
  hard.phases.push_back(phaseOf("withdraw", 3, [drive, start, duration](double end) {
    StepInput input = drive->at(duration);
    input.buttons = start.buttons;
    return between(input, start, std::clamp(end / 2.5, 0.0, 1.0));
  }));
  hard.phases.push_back(still("rest", 2, start));
  hard.phases.back().prepare = [](Simulation& simulation) { simulation.editState().procedure.sutures.clear(); };
  return hard;
}

// Inserts the scope until it touches, advances the helix and takes hold. `hard.model` and `hard.start` in and out.
// @returns the command that holds on
StepInput HardCases::takeHold(HardCase& hard) const {
  insertionAtContact(hard.model, hard.start);
  Simulation simulation(hard.model, SimulationSettings::study(1));
  simulation.replaceState(hard.start);
  StepInput input = holdAt(hard.start);
  input.joints[HelixAdvance] = bestAdvance(*hard.model, hard.start);
  for (int k = 0; k < 60; ++k) simulation.step(input);
  input.buttons[HelixGrab] = 1;
  simulation.step(input);
  if (simulation.state().grip.empty()) throw Error("The helix does not reach the wall; the hard case needs it.");
  hard.start = simulation.state();
  startClock(hard.start);
  return input;
}

HardCase HardCases::wind() const {
  HardCase hard = begin();
  JointLimits limits = model_->tool->limits()[HelixRotation];
  limits.upper = std::max(limits.upper, 2 * M_PI * (kTurns + 1));
  Scene scene = model_->scene;
  scene.helix->reach = std::max(scene.helix->reach, kWindReach);
  hard.model = modelWith(scene, withJointLimits(urdf_, "helix_rotation", limits), *model_);
  const StepInput input = takeHold(hard);
  const double turns = brief_ ? 4 : kTurns;
  StepInput wound = input, turned, pulled;
  wound.joints[HelixRotation] += 2 * M_PI * turns;
  turned = wound;
  turned.joints[Rotation] += turned.joints[Rotation] > 0 ? -M_PI : M_PI;
  pulled = turned;
  pulled.joints[Insertion] -= kWindPull;
  StepInput released = pulled;
  released.buttons[HelixGrab] = 0;
  released.joints[HelixAdvance] = 0;
  hard.phases.push_back(move("wind", 2 * M_PI * turns / (0.95 * limits.velocity), input, wound));
  hard.phases.push_back(move("turn", 1.5, wound, turned));
  hard.phases.push_back(move("pull", 1, turned, pulled));
  hard.phases.push_back(still("hold", 0.5, pulled));
  hard.phases.push_back(still("rest", brief_ ? 1 : 3, released));
  return hard;
}

// Wound in as far as it takes to hold with all of its force, then every joint at its own speed from limit to limit.
HardCase HardCases::jump(std::uint64_t seed) const {
  HardCase hard = begin();
  std::uint64_t random = seed;
  Scene scene = model_->scene;
  scene.helix->reach = kLeastReach + (kWindReach - kLeastReach) * nextUniform(random);
  hard.model = modelWith(scene, urdf_, *model_);
  StepInput wound;
  const StepInput start = takeHold(hard);
  wound = start;
  wound.joints[HelixRotation] = model_->tool->limits()[HelixRotation].upper;
  const double turning = wound.joints[HelixRotation] / model_->tool->limits()[HelixRotation].velocity;
  hard.phases.push_back(move("wind", 1.05 * turning, start, wound));
  std::vector<StepInput> jumps;
  const double duration = brief_ ? 5 : 20;
  for (int k = 0; k <= static_cast<int>(duration / kJumpTime); ++k) {
    jumps.push_back(wound);
    for (std::size_t j = 0; j < wound.joints.size(); ++j) {
      const JointLimits& limits = model_->tool->limits()[j];
      jumps.back().joints[j] = nextUniform(random) < 0.5 ? limits.lower : limits.upper;
    }
    if (k > 0 && nextUniform(random) < kPressProbability) jumps.back().buttons[HelixGrab] = 0;
  }
  const auto at = [jumps](double end) {
    return jumps[std::min(jumps.size() - 1, static_cast<std::size_t>(end / kJumpTime))];
  };
  StepInput still_there = jumps.back(), out = holdAt(settled_);
  still_there.buttons[HelixGrab] = 0;
  hard.phases.push_back(phaseOf("jump", duration, at));
  hard.phases.push_back(still("release", 0.25, still_there));
  hard.phases.push_back(still("withdraw", 3, out));
  hard.phases.push_back(still("rest", 3, out));
  return hard;
}

// In the middle of the body, where it is widest.
std::vector<std::vector<WallPoint>> HardCases::sleeveSets() const {
  const SurfaceView wall{model_->organ.surface.triangles, settled_.x, settled_.y, settled_.z};
  const WallPlan plan(model_->organ, wall);
  const double length = brief_ ? kSleeveLength : kSleeveLength / 2;
  std::vector<std::vector<WallPoint>> sets;
  for (const int k : brief_ ? std::vector<int>{0} : std::vector<int>{-1, 0, 1}) {
    const double from = 0.5 + 2 * k * length - length / 2;
    sets.emplace_back();
    for (const auto& [along, across] : {std::pair(0, -1), {0, 1}, {1, 1}, {1, -1}})
      sets.back().push_back(plan.at((from + along * length) * plan.length(), across * kSleeveWidth));
  }
  return sets;
}

// Wide sets whose threads draw the walls around the scope.
HardCase HardCases::sleeve() const {
  HardCase hard = begin();
  Scene scene = model_->scene;
  scene.suture->cinch_tension = kSleeveTension;
  scene.suture->cinch_speed = kSleeveSpeed;
  scene.suture->pull_out_force = kStrongTissue;
  hard.model = modelWith(scene, urdf_, *model_);
  insertionAtContact(hard.model, hard.start);
  startClock(hard.start);
  hard.returns = false;
  const StepInput inside = holdAt(hard.start);
  for (const auto& spots : sleeveSets()) addSet(spots, inside, hard);
  for (HardPhase& phase : hard.phases)
    if (phase.name == "cinch" && !brief_) phase.duration = kSleeveTime;
  StepInput outside = inside;
  outside.joints[Insertion] = settled_.joints[Insertion];
  const double way = inside.joints[Insertion] - outside.joints[Insertion];
  hard.phases.push_back(move("withdraw", way / kWithdraw, inside, outside));
  hard.phases.push_back(move("insert", way / kWithdraw, outside, inside));
  hard.phases.push_back(move("withdraw again", way / kWithdraw, inside, outside));
  hard.phases.push_back(still("rest", brief_ ? 1 : 3, outside));
  return hard;
}

}  // namespace vibe::benchmarks
