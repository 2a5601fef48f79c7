#include <limits>

#include <ros/ros.h>

#include "trainee/goal_player.hpp"
#include "trainee/trainee_player.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/startup.hpp"

// vibe_trainee: plays a trainee's script, or performs the goals of a protocol and of other nodes, on the simulator's
// input topics.

namespace {

constexpr char kHelp[] =
    "vibe_trainee: plays a trainee script, or performs the goals of a protocol and of other nodes.\n"
    "Usage: rosrun vibe_sim vibe_trainee [_script:=FILE] [_skill:=expert|novice] [_seed:=N] [_lockstep:=BOOL]\n"
    "       [_exit_when_done:=BOOL]; see docs/interfaces.md.\n";

struct Parameters {
  std::string script;
  std::string skill = "expert";
  int seed = 1;
  bool lockstep = false;
  bool exit_when_done = false;
};

Parameters readParameters() {
  Parameters parameters;
  vibe::ros_utils::ParameterReader reader(ros::NodeHandle("~"));
  reader.read("script", parameters.script);
  reader.read("skill", parameters.skill);
  reader.read("seed", parameters.seed, 0, std::numeric_limits<int>::max());
  reader.read("lockstep", parameters.lockstep);
  reader.read("exit_when_done", parameters.exit_when_done);
  reader.finish();
  if (!parameters.script.empty()) parameters.script = vibe::resolveAddress(parameters.script);
  if (parameters.skill != "expert" && parameters.skill != "novice")
    throw vibe::Error("Parameter ~skill is '" + parameters.skill + "'; give expert or novice, or a protocol.");
  return parameters;
}

void playScript(const Parameters& parameters) {
  const vibe::TraineeScript script = vibe::TraineeScript::load(parameters.script);
  ROS_INFO_STREAM("Playing '" << script.name() << "', " << script.duration() << " s.");
  vibe::sim::TraineePlayer player(ros::NodeHandle(), script, parameters.lockstep);
  ros::spin();
}

/// Of a trainee that only gets goals from other nodes.
vibe::Protocol noProtocol(const Parameters& parameters) {
  vibe::Protocol protocol;
  protocol.name = "goals of other nodes";
  if (parameters.skill == "novice") protocol.skill = vibe::Skill::novice();
  protocol.seed = static_cast<std::uint64_t>(parameters.seed);
  return protocol;
}

void performGoals(const vibe::Protocol& protocol, const Parameters& parameters) {
  ROS_INFO_STREAM("Performing '" << protocol.name << "', " << protocol.goals.size() << " goals.");
  vibe::sim::GoalPlayer player(ros::NodeHandle(), protocol, parameters.lockstep, parameters.exit_when_done);
  ros::spin();
}

void run() {
  const Parameters parameters = readParameters();
  if (parameters.script.empty()) return performGoals(noProtocol(parameters), parameters);
  if (vibe::isProtocol(parameters.script)) return performGoals(vibe::Protocol::load(parameters.script), parameters);
  playScript(parameters);
}

}  // namespace

int main(int argc, char** argv) {
  return vibe::ros_utils::runNode(argc, argv, "vibe_trainee", run, kHelp);
}
