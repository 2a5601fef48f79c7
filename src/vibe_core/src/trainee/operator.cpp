#include "trainee/operator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

// Design choice: from 0.6 of the allowed force on a hand slows down, to a fifth of its pace, so that what it still
// moves within its reaction time adds little.
constexpr double kCarefulFrom = 0.6;  // of Skill::force_limit
constexpr double kSlowest = 0.2;      // of the pace

}  // namespace

TraineeHand::TraineeHand(const Model& model, const Skill& skill, std::function<void()> next)
    : model_(model), skill_(skill), next_(std::move(next)) {}

void TraineeHand::perceive(const Observation& seen) {
  if (view_ == nullptr) command_.joints = seen.joints;
  view_ = &seen;
  events_.insert(events_.end(), seen.events.begin(), seen.events.end());
}

void TraineeHand::wait(double seconds) {
  const long steps = std::lround(seconds / model_.scene.step_period);
  for (long k = 0; k < steps; ++k) next_();
}

bool TraineeHand::await(const std::function<bool()>& condition, double patience) {
  const long steps = std::lround(patience / model_.scene.step_period);
  for (long k = 0; k < steps && !condition(); ++k) next_();
  return condition();
}

bool TraineeHand::moveTo(const Joints& joints, double min, const std::function<bool()>& stop) {
  return follow(joints, min, stop, [] { return 1.0; });
}

bool TraineeHand::feelTo(const Joints& joints, double min, const std::function<bool()>& stop) {
  const auto tooMuch = [&] { return feelsTooMuch() || (stop && stop()); };
  return follow(joints, min, tooMuch, [this] { return carefulRate(); });
}

bool TraineeHand::feelsMuch() const {
  return view_->force.norm() > kCarefulFrom * skill_.force_limit;
}

// What is felt now is answered a reaction time later.
double TraineeHand::carefulRate() const {
  const double felt = view_->force.norm() / skill_.force_limit;
  return std::clamp(1 - (felt - kCarefulFrom) / (1 - kCarefulFrom), kSlowest, 1.0);
}

// @param rate  of the pace
bool TraineeHand::follow(const Joints& joints, double min, const std::function<bool()>& stop,
                         const std::function<double()>& rate) {
  const Joints from = command_.joints;
  Joints to = from;
  for (int j = 0; j < kJointCount; ++j)
    if (std::isfinite(joints[j])) to[j] = joints[j];
  const double duration = std::max(min / skill_.pace, durationOfMotion(from, to, skill_.pace, model_.tool->limits()));
  const long steps = std::max(1L, std::lround(duration / model_.scene.step_period));
  for (double passed = 0; passed < static_cast<double>(steps);) {
    if (stop && stop()) return false;
    passed = std::min(passed + rate(), static_cast<double>(steps));
    const double part = minimumJerk(passed / static_cast<double>(steps));
    for (int j = 0; j < kJointCount; ++j) command_.joints[j] = from[j] + part * (to[j] - from[j]);
    next_();
  }
  return true;
}

bool TraineeHand::move(Joint joint, double position, double min, const std::function<bool()>& stop) {
  Joints joints;
  joints.fill(std::numeric_limits<double>::quiet_NaN());
  joints[joint] = position;
  return moveTo(joints, min, stop);
}

void TraineeHand::hold(Button button, double seconds) {
  press(button);
  wait(seconds);
  release(button);
  wait(0.1);  // so that the next press is one of its own
}

const Event* TraineeHand::find(Event::Kind kind) const {
  const auto found =
      std::find_if(events_.begin(), events_.end(), [kind](const Event& event) { return event.kind == kind; });
  return found == events_.end() ? nullptr : &*found;
}

double Operator::nextNormal() {
  double sum = -6;  // of twelve uniform numbers: variance 1
  for (int k = 0; k < 12; ++k) sum += nextUniform(random);
  return sum;
}

WallPoint Operator::withAimError(const WallPoint& target) {
  const double distal = skill().aim_error * nextNormal(), anterior = skill().aim_error * nextNormal();
  try {
    return map().walk(target, distal, anterior);
  } catch (const Error&) {
    return target;
  }
}

const AnatomicalMap& Operator::map() {
  if (!seen_map || (view().sets == 0 && seen_map->vertices() != view().wall))
    seen_map = std::make_shared<AnatomicalMap>(model().organ, view().wall);
  return *seen_map;
}

Eigen::Vector3d Operator::position(const WallPoint& point) const {
  return positionOf(point, model().organ.surface.triangles, view().wall);
}

Eigen::Vector3d Operator::outward(const WallPoint& point) const {
  return outwardAt(point, model().organ.surface.triangles, view().wall);
}

WallPoint find(const Place& place, const AnatomicalMap& map) {
  const double along = place.region ? map.alongIn(*place.region, place.along) : place.along;
  return map.walk(map.at(along, place.around), place.distal, place.anterior);
}

void stepBack(Operator& me) {
  TraineeHand::Joints joints = me.hand.joints();
  joints[Insertion] = std::min(joints[Insertion], 0.05);
  joints[TipUpDown] = joints[TipLeftRight] = 0;
  joints[HelixAdvance] = 2e-3;
  joints[HelixRotation] = joints[NeedleDriver] = 0;
  me.hand.moveTo(joints, 1);
}

namespace {

constexpr double kLeastInsertion = 0.05;  // with which the scope turns, straight, in the entry; design choice [m]
constexpr double kSmallTurn = 0.5;        // of a joint, up to which the way is direct; design choice [rad]

double turnBetween(const TraineeHand::Joints& a, const TraineeHand::Joints& b) {
  double turn = 0;
  for (int j = Rotation; j <= TipLeftRight; ++j) turn = std::max(turn, std::abs(a[j] - b[j]));
  return turn;
}

// Straight, in the entry: from there every place is reached on the way on which the scope comes back as well.
TraineeHand::Joints straight(const TraineeHand::Joints& joints) {
  TraineeHand::Joints out = joints;
  out[Insertion] = std::min(joints[Insertion], kLeastInsertion);
  out[TipUpDown] = out[TipLeftRight] = 0;
  return out;
}

}  // namespace

void retreat(Operator& me) {
  me.hand.moveTo(straight(me.hand.joints()), 0.5);
  me.hand.wait(me.skill().reaction_time);
}

bool travel(const TraineeHand::Joints& joints, Operator& me) {
  const auto tooMuch = [&me] { return me.hand.feelsTooMuch(); };
  if (tooMuch() || turnBetween(me.hand.joints(), joints) > kSmallTurn) {
    retreat(me);
    me.hand.move(Rotation, joints[Rotation], 0.2);
  }
  const bool arrived = me.hand.feelTo(joints, 0.3);
  if (!arrived) retreat(me);
  return arrived;
}

}  // namespace vibe
