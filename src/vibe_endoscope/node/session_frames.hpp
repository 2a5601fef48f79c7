#pragma once
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>
#include <vibe_msgs/SessionInfo.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "dataset/joint_tree.hpp"

namespace vibe::endoscope {

/// One state of a recorded session.
struct SessionFrame {
  sensor_msgs::PointCloud2::ConstPtr particles;
  vibe_msgs::SutureArray::ConstPtr sutures;      ///< the latest up to this state; null: none yet
  vibe_msgs::TissueTopology::ConstPtr topology;  ///< of these particles
};

/// The states of a whole recording, as `vibe_replay --fill` writes it, in the order of time, without a graph.
class SessionFrames {
 public:
  /// @throws std::runtime_error  the file is no such recording, in one sentence
  explicit SessionFrames(const std::string& file) {
    try {
      bag_.open(file, rosbag::bagmode::Read);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error("'" + file + "' cannot be read as a recording (" + error.what() + ").");
    }
    findTopics();
    rosbag::View infos(bag_, rosbag::TopicQuery(prefix_ + "session_info"));
    if (infos.size() == 0 || infos.begin()->instantiate<vibe_msgs::SessionInfo>()->urdf.empty())
      throw std::runtime_error(
          "'" + file + "' does not hold the URDF of the scope, so nothing tells where the camera is: " +
          (infos.size() == 0 ? "it has no message on session_info; if topics were chosen, keep that, else "
                               "record the session with this release."
                             : "the one in session_info is empty; record with a scope in the scene."));
    info_ = *infos.begin()->instantiate<vibe_msgs::SessionInfo>();
    poses_ = std::make_unique<JointTree>(info_.urdf);
    readFixedFrames();
    const std::vector<std::string> topics{prefix_ + "tissue/topology", prefix_ + "tissue/particles",
                                          prefix_ + "sutures", prefix_ + "joint_states"};
    view_ = std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery(topics));
    at_ = view_->begin();
  }

  /// Goes to the next state.
  /// @return whether there is one
  // The messages of a state have the same time in the bag, in any order.
  bool next(SessionFrame& frame) {
    while (at_ != view_->end()) {
      const ros::Time time = at_->getTime();
      if (pending_.particles && time > now_) break;
      now_ = time;
      take(*at_);
      ++at_;
    }
    if (!pending_.particles) return false;
    frame = pending_;
    pending_.particles.reset();
    return true;
  }

  /// What the session was made with.
  const vibe_msgs::SessionInfo& info() const { return info_; }
  /// Poses of all frames at the state that next() gave last.
  const JointTree& poses() const { return *poses_; }
  /// Time of the last message of the file [s].
  double end() const { return rosbag::View(bag_).getEndTime().toSec(); }

  /// Part of the recording that has been read, 0 to 1.
  double progress() const {
    const double whole = (view_->getEndTime() - view_->getBeginTime()).toSec();
    return whole > 0 ? (now_ - view_->getBeginTime()).toSec() / whole : 1;
  }

 private:
  // The simulator may run in a namespace; the type of its topology is its own.
  void findTopics() {
    rosbag::View topologies(bag_, rosbag::TypeQuery("vibe_msgs/TissueTopology"));
    const auto connections = topologies.getConnections();
    const std::string name = "tissue/topology";
    if (connections.empty() || connections[0]->topic.size() < name.size())
      throw std::runtime_error("'" + bag_.getFileName() +
                               "' has no topic tissue/topology, so there is nothing to see; if topics were "
                               "chosen, keep it.");
    if (connections.size() > 1 && connections[0]->topic != connections[1]->topic)
      throw std::runtime_error("'" + bag_.getFileName() +
                               "' holds several simulators; copy the topics of one with rosbag filter.");
    prefix_ = connections[0]->topic.substr(0, connections[0]->topic.size() - name.size());
  }

  static Eigen::Isometry3d poseOf(const geometry_msgs::Transform& from) {
    return Eigen::Translation3d(from.translation.x, from.translation.y, from.translation.z) *
           Eigen::Isometry3d(
               Eigen::Quaterniond(from.rotation.w, from.rotation.x, from.rotation.y, from.rotation.z).normalized());
  }

  void readFixedFrames() {
    rosbag::View view(bag_, rosbag::TopicQuery(std::vector<std::string>{"/tf_static", prefix_ + "tf_static"}));
    if (view.size() == 0)
      throw std::runtime_error("'" + bag_.getFileName() +
                               "' has no topic /tf_static, so nothing tells where the scope " +
                               "is; if topics were chosen, keep it, else record with scripts/record or scripts/run.");
    for (const rosbag::MessageInstance& message : view)
      for (const auto& transform : message.instantiate<tf2_msgs::TFMessage>()->transforms)
        poses_->setFixed(transform.child_frame_id, transform.header.frame_id, poseOf(transform.transform));
  }

  void take(const rosbag::MessageInstance& message) {
    if (const auto topology = message.instantiate<vibe_msgs::TissueTopology>()) pending_.topology = topology;
    if (const auto sutures = message.instantiate<vibe_msgs::SutureArray>()) pending_.sutures = sutures;
    if (const auto joints = message.instantiate<sensor_msgs::JointState>())
      poses_->setJoints(joints->name, joints->position);
    if (const auto particles = message.instantiate<sensor_msgs::PointCloud2>()) pending_.particles = particles;
  }

  rosbag::Bag bag_;
  std::string prefix_;  // of the simulator's topics
  vibe_msgs::SessionInfo info_;
  std::unique_ptr<JointTree> poses_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator at_;
  ros::Time now_;
  SessionFrame pending_;  // its particles are null after they were given away
};

}  // namespace vibe::endoscope
