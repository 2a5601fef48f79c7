#pragma once
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/SessionInfo.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TissueTopology.h>

#include <memory>
#include <optional>
#include <string>

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
  explicit SessionFrames(const std::string& file);
  ~SessionFrames();

  /// Goes to the next state.
  /// @return whether there is one
  bool next(SessionFrame& frame);

  /// What the session was made with.
  const vibe_msgs::SessionInfo& info() const { return info_; }
  /// Poses of all frames at the state that next() gave last.
  const JointTree& poses() const { return *poses_; }
  /// Time of the last message of the file [s].
  double end() const;
  /// Part of the recording that has been read, 0 to 1.
  double progress() const;

 private:
  void findTopics();
  void readFixedFrames();
  void take(const rosbag::MessageInstance& message);

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
