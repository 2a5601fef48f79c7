// vibe_trainee: plays a trainee's script, or performs the goals of a protocol, on the simulator's input topics.

#include <ros/ros.h>

#include <cstdio>

#include "goal_player.hpp"
#include "trainee_player.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_node/parameter_reader.hpp"

namespace {

struct Parameters {
  std::string script;
  bool lockstep = false;
  bool exit_when_done = false;
};

Parameters readParameters() {
  Parameters parameters;
  vibe::ParameterReader reader(ros::NodeHandle("~"));
  parameters.script = reader.required("script", "a trainee script, a protocol, or the package:// address of one");
  reader.read("lockstep", parameters.lockstep);
  reader.read("exit_when_done", parameters.exit_when_done);
  reader.finish();
  parameters.script = vibe::resolveAddress(parameters.script);
  return parameters;
}

void playScript(const Parameters& parameters) {
  const vibe::TraineeScript script = vibe::TraineeScript::load(parameters.script);
  ROS_INFO_STREAM("Playing '" << script.name() << "', " << script.duration() << " s.");
  vibe::TraineePlayer player(ros::NodeHandle(), script, parameters.lockstep);
  ros::spin();
}

void performProtocol(const Parameters& parameters) {
  const vibe::Protocol protocol = vibe::Protocol::load(parameters.script);
  ROS_INFO_STREAM("Performing '" << protocol.name << "', " << protocol.goals.size() << " goals.");
  vibe::GoalPlayer player(ros::NodeHandle(), protocol, parameters.lockstep, parameters.exit_when_done);
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "vibe_trainee");
    const Parameters parameters = readParameters();
    if (vibe::isProtocol(parameters.script)) {
      performProtocol(parameters);
    } else {
      playScript(parameters);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_trainee: %s\n", error.what());
    return 2;
  }
}
