#include <algorithm>
#include <cstdio>

#include <ros/ros.h>

#include "publishing/publishers.hpp"
#include "simulation/scene_source.hpp"
#include "simulator/inputs.hpp"
#include "simulator/master_watch.hpp"
#include "simulator/parameters.hpp"
#include "simulator/services.hpp"
#include "simulator/simulation_thread.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/startup.hpp"
#include "vibe_ros_utils/wall_clock.hpp"

// sim_node: the simulator as a ROS node. Messages in (inputs), steps (stepping), messages out (publishers).

namespace sim = vibe::sim;

namespace {

constexpr int kFailure = 1;
constexpr double kDelivery = 1.0;  // for listeners to receive what was sent last [s]

constexpr char kHelp[] =
    "sim_node: the simulator as a ROS node.\n"
    "Usage: rosrun vibe_sim sim_node _scene:=FILE [_PARAMETER:=VALUE]...\n"
    "Parameters: scene, mesh, seed, time_source, fast, follow, lockstep, lockstep_timeout, input_look_ahead, "
    "input_staleness,\n"
    "velocity_life, start_paused, await_recorder, threads, realtime_priority, duration, summary_file, master_timeout; "
    "see docs/interfaces.md.\n";

void waitForEnd(const sim::SimulationThread& thread, const sim::MasterWatch& watch) {
  while (ros::ok() && vibe::ros_utils::stopSignal() == 0 && thread.isRunning() && !watch.isHopeless())
    ros::WallDuration(0.02).sleep();
}

/// The sentence that says why the node ends, unless the stepping has said so itself.
void explainEnd(const sim::MasterWatch& watch) {
  if (vibe::ros_utils::stopSignal() != 0) {
    std::puts("Stopped by a signal.");
  } else if (!ros::ok() && !watch.isHopeless()) {
    std::puts(
        "Stopped because the ROS master said so: another node of this name was started, or somebody ran rosnode kill.");
  }
  std::fflush(stdout);
}

/// The threads of ROS too: with a lower priority they would be interrupted while they hold a lock that the stepping
/// thread needs to send its messages. That one is a little above them.
void runInRealTime(int priority) {
  for (const std::string& sentence : vibe::ros_utils::runInRealTime(std::max(1, priority - 1)))
    ROS_WARN_STREAM(sentence);
}

int run() {
  ros::NodeHandle handle;
  const sim::Parameters parameters = sim::readParameters(ros::NodeHandle("~"));
  if (parameters.realtime_priority > 0) runInRealTime(parameters.realtime_priority);
  const sim::SceneModel made = sim::loadModel(parameters.scene, parameters.mesh);
  const vibe::Model* model = made.model.get();
  // Not only for people: the first log message makes roscpp register a parameter at the master, and if that were the
  // message about our own shutdown, the master would take us for the newest node of this name and stop the real one.
  ROS_INFO_STREAM("Simulating '" << model->scene.name << "' with " << model->particle_count << " particles.");
  vibe::ros_utils::ParameterReader(ros::NodeHandle("~")).log();
  sim::InputQueue queue;
  sim::Publishers publishers(handle, parameters.time_source == sim::TimeSource::Sim);
  sim::SimulationThread thread(parameters, made, queue, publishers);
  ros::AsyncSpinner spinner(1);
  sim::MasterWatch watch(handle, publishers, parameters.master_timeout);
  {
    sim::Inputs inputs(
        handle, queue, publishers, parameters.input_window,
        [&] { return parameters.time_source == sim::TimeSource::Wall ? vibe::ros_utils::wallTime() : queue.now(); },
        [&thread](sim::InputChannel channel) { thread.wake(channel); });
    sim::Services services(handle, thread, publishers);
    thread.start();
    spinner.start();
    waitForEnd(thread, watch);
    thread.stop();
  }
  explainEnd(watch);
  const bool has_end = parameters.duration > 0;
  if (has_end || !parameters.summary_file.empty()) thread.finish();
  if (ros::ok() && publishers.hasListener()) ros::WallDuration(kDelivery).sleep();
  if (thread.outcome() == sim::Outcome::Finished) return 0;
  const bool failed = thread.outcome() == sim::Outcome::Failed || watch.isHopeless();
  return failed || has_end ? kFailure : 0;
}

}  // namespace

int main(int argc, char** argv) {
  int result = vibe::ros_utils::asksForHelp(argc, argv) ? 0 : kFailure;  // a signal may come before there is a master
  const int failure = vibe::ros_utils::runNodeWithGoodbye(
      argc, argv, "sim_node", [&] { result = run(); }, kHelp);
  return failure != 0 ? failure : result;
}
