#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <vibe_msgs/ReplayStatus.h>
#include <vibe_msgs/TissueTopology.h>

#include "protocol/frame_message.hpp"
#include "protocol/wall_look.hpp"
#include "scene_text.hpp"
#include "server/web_server.hpp"
#include "state_text.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"

namespace vibe::web {

/// Follows the topics of a simulator, or of vibe_player, and gives a server what pages show of them. While no page
/// looks it reads the small topics only.
class SessionStream {
 public:
  SessionStream(const ros::NodeHandle& handle, WebServer& server);
  ~SessionStream();

  /// Ten times a second: what changes slowly.
  void tick();
  /// Whether what is shown is a recording, which cannot be driven.
  bool showsRecording() const { return replay_ != nullptr; }

 private:
  void takeTopology(const vibe_msgs::TissueTopology& message);
  void takeParticles(const ros::MessageEvent<const sensor_msgs::PointCloud2>& event);
  void takeJoints(const sensor_msgs::JointState& message);
  void takeTransforms(const tf2_msgs::TFMessage& message);
  void takeSutures(const vibe_msgs::SutureArray::ConstPtr& message);
  void findRobot();
  void takeReplay(const ros::MessageEvent<const vibe_msgs::ReplayStatus>& event);
  void watchRecording();
  void watchHealth();
  void publishScene();
  void publishFrame();
  void publishSutures();
  void publishThreads(const graphics::SutureDrawing& drawing);
  void publishWall();
  void warn(const std::string& sentence);

  struct Organ;  // a topology, and what follows from it

  ros::NodeHandle handle_;
  WebServer& server_;
  nlohmann::json scene_;
  std::unique_ptr<Organ> organ_;
  graphics::TissueFrame frame_;
  FrameContent content_;
  ros::Subscriber particles_, replays_;
  std::vector<ros::Subscriber> subscribers_;   // of all other topics
  sensor_msgs::PointCloud2::ConstPtr unseen_;  // particles that no page has got
  vibe_msgs::ProcedureState::ConstPtr state_;
  vibe_msgs::ReplayStatus::ConstPtr replay_;
  vibe_msgs::SkillMetrics::ConstPtr skill_;
  vibe_msgs::SutureArray::ConstPtr sutures_;
  EventList events_;
  Bytes threads_;  // as last sent
  std::string last_warning_, state_text_, health_text_;
  bool has_frame_ = false, events_changed_ = true, sutures_changed_ = false;
  std::size_t thread_points_ = 0;  // of the threads as last sent
  int ticks_ = 0, threads_due_ = 0, blood_due_ = 0;
  ros::SteadyTime heard_;         // the last state, or word that it stays
  ros::SteadyTime replay_heard_;  // the last word of a player
  std::string player_, source_;   // names of the nodes that say replay_, and that sent the last state
};

}  // namespace vibe::web
