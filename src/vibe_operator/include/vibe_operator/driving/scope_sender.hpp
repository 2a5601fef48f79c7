#pragma once
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/ProcedureState.h>

#include <array>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "vibe_operator/drive/scope_drive.hpp"
#include "vibe_operator/messages/session_watch.hpp"

namespace vibe::operating {

/// What to show to a person who drives.
struct DriveView {
  bool driving = false;                ///< joints are being published
  std::string trouble;                 ///< why nothing moves, or no button works, in one sentence; empty if all is well
  FirstStep step;                      ///< the next thing to do; without a simulator number 0
  std::set<int> keys_down;             ///< that drive, by their numbers
  DriveGear gear = DriveGear::Normal;  ///< of the keys
  Joints joints{};                     ///< NaN: unknown
  JointLimits limits{};                ///< by DriveJoint; all 0 before they are known
  std::array<bool, 6> buttons{};       ///< in the order of scope/buttons
  double force = std::numeric_limits<double>::quiet_NaN();  ///< of the tissue on the tool [N]; NaN: unknown
  vibe_msgs::ProcedureState::ConstPtr state;                ///< null: not come yet
};

/// Publishes the joints of a ScopeDrive on scope/servo_jp and suturing_device/input/joint_states, 60 times a second in
/// a thread of its own, so that slow drawing does not make the motion rough. It begins where the simulator's joints are
/// and is silent while there is no simulator, while time stands still, and while another node drives the scope.
/// Functions may be called from any thread; changes of buttons are reported in the thread of the call.
class ScopeSender {
 public:
  /// @param button_changed  called where a key presses or releases a button
  explicit ScopeSender(ScopeDrive::ButtonChange button_changed);
  ~ScopeSender();

  /// @param name_space  valid; empty: that of the node
  void start(const std::string& name_space);
  /// Releases all keys; falls silent when the joints have come to rest.
  void stop();

  void setSpeeds(const DriveSpeeds& speeds);  ///< see ScopeDrive, as for what follows
  void keyDown(int key);                      ///< its motion begins
  void keyUp(int key);                        ///< its motion ends
  void releaseAll();                          ///< as if no key were down
  void displace(int joint, double by);        ///< at once [m], [rad]

  /// Ten times a second: after a second without it the program hangs, and keys of joints count as let go.
  /// @return without `step` and `buttons`, and with what keeps the joints from moving as trouble
  DriveView view() const;

 private:
  mutable std::mutex mutex_;  // of everything below except queue, spinner and timer
  ScopeDrive drive_;
  bool active_ = false, driving_ = false, connected_ = false, has_limits_ = false;
  std::string requested_, trouble_;
  JointLimits limits_{};
  Joints seen_{};                  // of the simulator
  std::optional<Joints> present_;  // the same, if they came since the joints were last driven
  vibe_msgs::ProcedureState::ConstPtr state_;
  double force_;
  ros::Time last_;                                                           // up to which the joints have moved
  double waiting_since_ = 0, driving_since_ = 0, wanted_ = 0, seen_at_ = 0;  // steady clock [s]
  double passed_at_ = 0;                                                     // time; steady clock [s]
  mutable double heard_ = 0;                                                 // of the program; steady clock [s]
  SimulatorWatch simulator_;
  ControlWatch same_topic_, other_topic_;

  ros::CallbackQueue queue_;
  ros::NodeHandle handle_, topics_;
  ros::Publisher scope_, suturing_device_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;
  ros::AsyncSpinner spinner_;

  void tick();
  void connect();
  void disconnect();
  template <class Message>
  void watch(const std::string& topic, ControlWatch& watch);
  void takeState(const vibe_msgs::ProcedureState::ConstPtr& state);
  std::string findTrouble();
  std::string findLimits();
  bool begin(const ros::Time& now);
  bool moveTo(const ros::Time& now);
  bool standsStill() const;
  void endDriving();
};

}  // namespace vibe::operating
