#include "simulator/parameters.hpp"

#include <cmath>

#include <ros/param.h>

#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"

namespace vibe::sim {

namespace {

TimeSource readTimeSource(ros_utils::ParameterReader& reader) {
  std::string word = "wall";
  reader.read("time_source", word);
  if (word == "wall") return TimeSource::Wall;
  if (word == "sim") return TimeSource::Sim;
  throw Error("Parameter ~time_source is '" + word + "'; set it to wall or sim.");
}

std::optional<InputChannel> readFollow(ros_utils::ParameterReader& reader) {
  std::string topic;
  reader.read("follow", topic);
  if (topic.empty()) return std::nullopt;
  for (const InputChannel channel : {InputChannel::Scope, InputChannel::SuturingDevice})
    if (topic == toString(channel)) return channel;
  throw Error("Parameter ~follow is '" + topic +
              "'; set it to scope/input/joint_states or suturing_device/input/joint_states.");
}

std::optional<std::uint64_t> readSeed(ros_utils::ParameterReader& reader) {
  int seed = -1;
  reader.read("seed", seed, 0, 2147483647);
  if (seed < 0) return std::nullopt;
  return static_cast<std::uint64_t>(seed);
}

InputWindow readInputWindow(ros_utils::ParameterReader& reader, TimeSource source) {
  InputWindow window = source == TimeSource::Sim ? InputWindow::ofSimulatedTime() : InputWindow::ofWallClock();
  double look_ahead = -1, staleness = -1;
  reader.read("input_look_ahead", look_ahead, 0, 1e6, "s");
  reader.read("input_staleness", staleness, 0, 1e6, "s");
  if (look_ahead >= 0) window.look_ahead = static_cast<std::int64_t>(1e9 * look_ahead);
  if (staleness >= 0) window.staleness = static_cast<std::int64_t>(1e9 * staleness);
  return window;
}

/// All nodes must agree on whose time it is before any of them reads it.
void checkSimTime(TimeSource source) {
  bool use_sim_time = false;
  ros::param::get("/use_sim_time", use_sim_time);
  if (source == TimeSource::Sim && !use_sim_time) {
    throw Error(
        "Parameter ~time_source is sim, but /use_sim_time is not true, so that other nodes would read the wall clock; "
        "run 'rosparam set /use_sim_time true' before any node starts.");
  }
  if (source == TimeSource::Wall && use_sim_time) {
    throw Error(
        "Parameter ~time_source is wall, but /use_sim_time is true, so that other nodes would wait for a clock that "
        "nobody publishes; run 'rosparam delete /use_sim_time' before any node starts or set ~time_source to sim.");
  }
}

void checkCombination(const Parameters& parameters) {
  if (parameters.realtime_priority > 0 && parameters.fast)
    throw Error("Parameter ~realtime_priority excludes ~fast: the step that never waits would take a core for itself.");
  if (parameters.follow && (parameters.fast || parameters.lockstep))
    throw Error("Parameter ~follow excludes ~fast and ~lockstep: their steps do not follow the wall clock.");
  if (parameters.time_source == TimeSource::Sim) return;
  if (parameters.fast) throw Error("Parameter ~fast needs ~time_source sim: the wall clock cannot run faster.");
  if (parameters.lockstep) throw Error("Parameter ~lockstep needs ~time_source sim: the wall clock does not wait.");
}

}  // namespace

Parameters readParameters(const ros::NodeHandle& private_handle) {
  ros_utils::ParameterReader reader(private_handle);
  Parameters parameters;
  parameters.scene = reader.required("scene", "a scene file or package:// address");
  reader.read("mesh", parameters.mesh);
  parameters.seed = readSeed(reader);
  parameters.time_source = readTimeSource(reader);
  reader.read("fast", parameters.fast);
  parameters.follow = readFollow(reader);
  reader.read("lockstep", parameters.lockstep);
  reader.read("lockstep_timeout", parameters.lockstep_timeout, 0.1, 86400, "s");
  parameters.input_window = readInputWindow(reader, parameters.time_source);
  double velocity_life = 1e-9 * kVelocityLife;
  reader.read("velocity_life", velocity_life, 0.05, 60, "s");
  parameters.velocity_life = std::llround(1e9 * velocity_life);
  reader.read("start_paused", parameters.start_paused);
  reader.read("await_recorder", parameters.await_recorder);
  reader.read("threads", parameters.threads, 1, 256);
  reader.read("realtime_priority", parameters.realtime_priority, 0, 99);
  reader.read("duration", parameters.duration, 0, 1e6, "s");
  reader.read("summary_file", parameters.summary_file);
  reader.read("master_timeout", parameters.master_timeout, 0.1, 1e6, "s");
  reader.finish();
  checkCombination(parameters);
  checkSimTime(parameters.time_source);
  return parameters;
}

}  // namespace vibe::sim
