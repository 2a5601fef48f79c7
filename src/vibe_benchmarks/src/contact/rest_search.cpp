#include "contact/rest_search.hpp"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "output/result_row.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kApproachTime = 1.5;  // [s]
constexpr double kLook = 1;            // [s]
constexpr double kRestSpeed = 1e-5;    // [m/s]
constexpr double kShallowest = 0.04;   // insertion: less is in the oesophagus [m]
constexpr int kLongestPeriod = 30;     // steps
constexpr double kReturns = 0.1;       // of the motion: so near to where it was, a particle is back
constexpr double kOneWay = 0.3;        // of the motion: thirds of the second that are farther apart are on one way

double farthestBetween(const std::array<std::vector<double>, 3>& a, const std::array<std::vector<double>, 3>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a[0].size(); ++i)
    most = std::max(most, std::hypot(a[0][i] - b[0][i], a[1][i] - b[1][i], a[2][i] - b[2][i]));
  return most;
}

StepInput drawPose(const ToolModel& tool, std::uint64_t& random) {
  StepInput input;
  for (int j = 0; j < kScopeJointCount; ++j) {
    const JointLimits& limit = tool.limits()[j];
    const double lower = j == Insertion ? std::max(kShallowest, limit.lower) : limit.lower;
    input.joints[j] = lower + (limit.upper - lower) * nextUniform(random);
  }
  return input;
}

HeldPose holdPose(const StepInput& goal, double hold, Simulation& simulation) {
  const double step = simulation.stepPeriod();
  const auto stepsIn = [&](double time) { return static_cast<int>(std::lround(time / step)); };
  const std::array<double, kJointCount> from = simulation.state().joints;
  for (int k = 1, steps = stepsIn(kApproachTime); k <= steps; ++k) {
    StepInput input = goal;
    for (int j = 0; j < kJointCount; ++j) input.joints[j] = from[j] + k * (goal.joints[j] - from[j]) / steps;
    simulation.step(input);
  }
  for (int k = 0; k < stepsIn(hold); ++k) simulation.step(goal);
  HeldPose pose;
  RestDetector detector(step);
  double least = HUGE_VAL, most = 0;
  for (int k = 0; k < stepsIn(kLook); ++k) {
    detector.add(simulation.state());
    simulation.step(goal);
    pose.force = simulation.state().tool_force.norm();
    least = std::min(least, pose.force), most = std::max(most, pose.force);
  }
  std::copy_n(goal.joints.begin(), kScopeJointCount, pose.joints.begin());
  pose.force_range = most - least;
  pose.contacts = simulation.state().contact_count;
  pose.motion = detector.motion(), pose.drift = detector.drift(), pose.speed = detector.speed();
  pose.period = detector.period();
  pose.wall = detector.wall();
  return pose;
}

}  // namespace

const char* nameOf(HeldWall wall) {
  return wall == HeldWall::Rests ? "rests" : wall == HeldWall::Creeps ? "creeps" : "trembles";
}

void RestDetector::add(const State& state) {
  seen_.push_back({state.x, state.y, state.z});
  if (seen_.size() > 1) speed_ = std::max(speed_, farthestBetween(seen_.end()[-2], seen_.back()) / step_);
}

HeldWall RestDetector::wall() const {
  if (speed_ <= kRestSpeed) return HeldWall::Rests;
  return drift() > kOneWay * motion() ? HeldWall::Creeps : HeldWall::Trembles;
}

double RestDetector::motion() const {
  double most = 0;
  for (std::size_t i = 0; !seen_.empty() && i < seen_.front()[0].size(); ++i) {
    double diagonal2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const Positions& positions : seen_)
        low = std::min(low, positions[k][i]), high = std::max(high, positions[k][i]);
      diagonal2 += (high - low) * (high - low);
    }
    most = std::max(most, std::sqrt(diagonal2));
  }
  return most;
}

double RestDetector::drift() const {
  const std::size_t third = seen_.size() / 3;
  return third == 0 ? 0 : farthestBetween(mean(0, third), mean(seen_.size() - third, seen_.size()));
}

RestDetector::Positions RestDetector::mean(std::size_t begin, std::size_t end) const {
  Positions sum = seen_[begin];
  for (std::size_t n = begin + 1; n < end; ++n)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < sum[k].size(); ++i) sum[k][i] += seen_[n][k][i];
  for (auto& axis : sum)
    for (double& value : axis) value /= static_cast<double>(end - begin);
  return sum;
}

int RestDetector::period() const {
  if (wall() != HeldWall::Trembles) return 0;
  const int last = static_cast<int>(seen_.size()) - 1;
  const double near = kReturns * motion();
  const auto returnsAfter = [&](int period) {
    for (int k = last; k >= std::max(period, last - kLongestPeriod); --k)
      if (farthestBetween(seen_[k], seen_[k - period]) >= near) return false;
    return true;
  };
  for (int period = 1; period <= std::min(kLongestPeriod, last); ++period)
    if (returnsAfter(period)) return period;
  return 0;
}

void searchRest(std::shared_ptr<const Model> model, int poses, std::uint64_t seed, double hold,
                const std::function<void(const HeldPose&)>& take) {
  SutureSession session(model);
  session.settle();
  const State start = session.state();
  Simulation simulation(model, SimulationSettings::study(1));
  std::uint64_t random = seed;
  for (int number = 1; number <= poses; ++number) {
    simulation.replaceState(start);
    HeldPose pose = holdPose(drawPose(*model->tool, random), hold, simulation);
    pose.particles = model->particle_count;
    pose.pose = number;
    take(pose);
  }
}

void writeHeldHeader(std::ostream& out) {
  out << "particles,pose,insertion_mm,rotation,tip_up_down,tip_left_right,force_N,force_range_N,contacts,motion_mm,"
         "drift_mm,speed_mm_s,period_steps,wall\n";
}

void writeHeldPose(const HeldPose& pose, std::ostream& out) {
  out << formatted("%d,%d,%.3f,%.4f,%.4f,%.4f,%.4g,%.3g,%d,%.4g,%.4g,%.4g,%d,%s\n", pose.particles, pose.pose,
                   1e3 * pose.joints[Insertion], pose.joints[Rotation], pose.joints[TipUpDown],
                   pose.joints[TipLeftRight], pose.force, pose.force_range, pose.contacts, 1e3 * pose.motion,
                   1e3 * pose.drift, 1e3 * pose.speed, pose.period, nameOf(pose.wall));
}

}  // namespace vibe::benchmarks
