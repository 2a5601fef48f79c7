#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <ros/node_handle.h>

#include "input/input_interpreter.hpp"

namespace vibe::sim {

enum class TimeSource {
  Wall,  ///< stamps follow the wall clock, no /clock
  Sim    ///< stamps start at one second, /clock is published
};

/// Settings of sim_node, from its private parameters. docs/interfaces.md says what each does.
struct Parameters {
  std::string scene;                  ///< file or package:// address; required
  std::string mesh;                   ///< surface file or package:// address instead of the scene\'s organ
  std::optional<std::uint64_t> seed;  ///< instead of the scene's
  TimeSource time_source = TimeSource::Wall;
  bool fast = false;                   ///< do not wait for the wall clock
  std::optional<InputChannel> follow;  ///< steps begin when its samples arrive
  bool lockstep = false;               ///< wait for the inputs of every step
  double lockstep_timeout = 10;        ///< [s] of wall time
  bool start_paused = false;
  bool await_recorder = false;  ///< no step before somebody listens to applied_input
  int threads = 1;              ///< inside a step
  int realtime_priority = 0;    ///< of the stepping thread, SCHED_FIFO; 0: an ordinary thread
  InputWindow input_window = InputWindow::ofWallClock();
  std::int64_t velocity_life = kVelocityLife;  ///< [ns]
  double duration = 0;                         ///< simulated time after which the node ends; 0: never [s]
  std::string summary_file;                    ///< empty: none
  double master_timeout = 30;                  ///< [s] of wall time without a master and without any listener
};

/// @throws Error for an unknown parameter, one of a wrong type or out of range, and settings that exclude each other
///         or do not fit /use_sim_time
Parameters readParameters(const ros::NodeHandle& private_handle);

}  // namespace vibe::sim
