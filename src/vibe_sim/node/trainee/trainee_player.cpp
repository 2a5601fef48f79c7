#include "trainee/trainee_player.hpp"

#include <algorithm>
#include <cstdio>

#include "conversions/conversions.hpp"
#include "simulation/timed_simulation.hpp"
#include "vibe_core/clocks/step_timer.hpp"

namespace vibe::sim {

namespace {

constexpr std::int64_t kStepsAhead = 8;
constexpr std::int64_t kSamplePeriod = 10'000'000;  // 100 Hz [ns]
constexpr std::int64_t kButtonInterval = 10;        // samples between buttons that do not change
constexpr std::int64_t kMaxBacklog = 100;           // samples; more are skipped

}  // namespace

TraineePlayer::TraineePlayer(ros::NodeHandle handle, TraineeScript script, bool lockstep)
    : script_(std::move(script)), sender_(handle) {
  if (!lockstep) {
    timer_ = handle.createWallTimer(ros::WallDuration(0.002), &TraineePlayer::sample, this);
    return;
  }
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  procedure_ = handle.subscribe("procedure/state", 10, &TraineePlayer::onProcedure, this, no_delay);
  clock_ = handle.subscribe("/clock", 100, &TraineePlayer::onClock, this, no_delay);
  timer_ = handle.createWallTimer(ros::WallDuration(0.1), &TraineePlayer::resend, this);
}

void TraineePlayer::onProcedure(const vibe_msgs::ProcedureState& message) {
  step_period_ = message.step_period;
  origin_ = fromRosTime(message.origin);
  sendAhead();
}

void TraineePlayer::onClock(const rosgraph_msgs::Clock& message) {
  const std::int64_t now = fromRosTime(message.clock);
  if (now == clock_now_) return;
  last_change_ = steadyTime();
  // time has been set back: the session starts again, and so does the script
  if (now < clock_now_) next_step_ = 0;
  clock_now_ = now;
  sendAhead();
}

void TraineePlayer::sendAhead() {
  if (clock_now_ < 0 || step_period_ <= 0 || !sender_.hasListeners()) return;
  const std::int64_t now = stepAt(origin_, clock_now_, step_period_);
  next_step_ = std::max(next_step_, now);
  for (; next_step_ <= now + kStepsAhead; ++next_step_) {
    send(static_cast<double>(next_step_) * step_period_, stampOf(origin_, next_step_, step_period_));
  }
}

void TraineePlayer::resend(const ros::WallTimerEvent&) {
  const double now = steadyTime();
  if (now - last_change_ < kResendAfter) return;
  last_change_ = now;
  if (clock_now_ >= 0 && step_period_ > 0) next_step_ = stepAt(origin_, clock_now_, step_period_);
  sendAhead();
}

void TraineePlayer::sample(const ros::WallTimerEvent&) {
  const ros::Time ros_now = ros::Time::now();
  if (ros_now.isZero() || !sender_.hasListeners()) return;
  const std::int64_t now = fromRosTime(ros_now);
  if (begin_ < 0 || now < begin_) {
    begin_ = now;
    next_sample_ = 0;
  }
  const std::int64_t due = (now - begin_) / kSamplePeriod;
  next_sample_ = std::max(next_sample_, due - kMaxBacklog);
  for (; next_sample_ <= due; ++next_sample_) {
    send(1e-9 * static_cast<double>(next_sample_ * kSamplePeriod), begin_ + next_sample_ * kSamplePeriod);
  }
}

void TraineePlayer::send(double script_time, std::int64_t stamp) {
  const StepInput input = script_.at(script_time);
  const bool lockstep = step_period_ > 0;
  const bool with_buttons = lockstep || input.buttons != last_sent_.buttons || next_sample_ % kButtonInterval == 0;
  sender_.send(input, stamp, with_buttons);
  last_sent_ = input;
  sayPhase(script_time);
}

void TraineePlayer::sayPhase(double script_time) {
  const std::string& phase = script_.phaseAt(script_time);
  if (phase == phase_) return;
  phase_ = phase;
  std::printf("trainee: t = %.2f s  %s\n", script_time, phase.c_str());
  std::fflush(stdout);
}

}  // namespace vibe::sim
