#pragma once

#include <cstdint>
#include <string>

#include <ros/node_handle.h>
#include <rosgraph_msgs/Clock.h>
#include <vibe_msgs/ProcedureState.h>

#include "trainee/trainee_topics.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe::sim {

/// Plays a trainee's script on the ordinary input topics, as a device would. After the script's end it holds its last
/// position.
class TraineePlayer {
 public:
  /// @param lockstep  send the inputs of every step, stamped with the step's time, some steps ahead of /clock;
  ///                  else sample the script at 100 Hz of ROS time from the first listener on
  TraineePlayer(ros::NodeHandle handle, TraineeScript script, bool lockstep);

 private:
  // lock-step
  void onProcedure(const vibe_msgs::ProcedureState& message);
  void onClock(const rosgraph_msgs::Clock& message);
  void sendAhead();
  void resend(const ros::WallTimerEvent& event);
  // free running
  void sample(const ros::WallTimerEvent& event);

  void send(double script_time, std::int64_t stamp);
  void sayPhase(double script_time);

  TraineeScript script_;
  InputSender sender_;
  ros::Subscriber procedure_, clock_;
  ros::WallTimer timer_;
  std::string phase_;

  double step_period_ = 0;       // 0: not known yet [s]
  std::int64_t origin_ = 0;      // [ns]
  std::int64_t clock_now_ = -1;  // last /clock; -1: none [ns]
  std::int64_t next_step_ = 0;   // the first that has not been sent
  double last_change_ = 0;       // of /clock, steady time [s]

  std::int64_t begin_ = -1;  // stamp at which the script began; -1: not yet [ns]
  std::int64_t next_sample_ = 0;
  StepInput last_sent_;
};

}  // namespace vibe::sim
