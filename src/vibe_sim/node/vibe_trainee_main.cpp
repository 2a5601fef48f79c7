// vibe_trainee: plays a trainee's script on the simulator's input topics.

#include <ros/ros.h>

#include <cstdio>

#include "trainee_player.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_node/parameter_reader.hpp"

namespace {

void play() {
  ros::NodeHandle handle;
  vibe::ParameterReader reader(ros::NodeHandle("~"));
  const std::string script = reader.required("script", "a trainee script or its package:// address");
  bool lockstep = false;
  reader.read("lockstep", lockstep);
  reader.finish();
  const vibe::TraineeScript played = vibe::TraineeScript::load(vibe::resolveAddress(script));
  ROS_INFO_STREAM("Playing '" << played.name() << "', " << played.duration() << " s.");
  vibe::TraineePlayer player(handle, played, lockstep);
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "vibe_trainee");
    play();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_trainee: %s\n", error.what());
    return 2;
  }
}
