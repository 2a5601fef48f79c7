#include <ros/ros.h>

#include "replay/player.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/startup.hpp"

// vibe_player: plays a recording into the graph, where rviz shows it; goes to any time on command.

namespace {

constexpr double kIdle = 0.002;  // [s]

constexpr char kHelp[] =
    "vibe_player: plays a recording into the graph.\n"
    "Usage: rosrun vibe_sim vibe_player _recording:=BAG [_play:=true] [_rate:=1.0] [_session:=S]\n"
    "                                   [_namespace:=NS]\n"
    "It needs /use_sim_time true, takes replay/command and says where it is on replay/status.\n";

void play() {
  vibe::ros_utils::ParameterReader reader(ros::NodeHandle("~"));
  const std::string file = reader.required("recording", "the bag to play");
  bool plays = true;
  double rate = 1;
  reader.read("play", plays);
  reader.read("rate", rate, 0.01, 100, "");
  vibe::sim::SessionChoice choice;
  reader.read("session", choice.session);
  reader.read("namespace", choice.name_space);
  reader.finish();
  bool use_sim_time = false;
  if (!ros::param::get("/use_sim_time", use_sim_time) || !use_sim_time)
    throw vibe::Error("/use_sim_time is not true; run 'rosparam set /use_sim_time true' before any node starts.");
  const vibe::sim::Recording recording(file, choice);
  if (!recording.remarkOnChoice().empty()) ROS_INFO_STREAM(recording.remarkOnChoice());
  vibe::sim::Player player(recording, ros::NodeHandle(), plays, rate);
  while (ros::ok() && vibe::ros_utils::stopSignal() == 0) {
    player.spinOnce();
    ros::WallDuration(kIdle).sleep();
  }
}

}  // namespace

int main(int argc, char** argv) {
  return vibe::ros_utils::runNodeWithGoodbye(argc, argv, "vibe_player", play, kHelp);
}
