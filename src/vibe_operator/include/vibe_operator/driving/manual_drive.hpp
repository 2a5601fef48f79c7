#pragma once

#include <array>
#include <memory>
#include <set>
#include <string>

#include <vibe_msgs/ProcedureState.h>

#include "vibe_operator/drive/scope_drive.hpp"

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
  double force = 0;                    ///< of the tissue on the tool [N]; NaN: unknown
  vibe_msgs::ProcedureState::ConstPtr state;  ///< null: not come yet
};

/// Drives the scope and the suturing device with keys: publishes scope/servo_jp and
/// suturing_device/input/joint_states in a thread of its own, and scope/buttons while nobody else presses them. The
/// tool 'Drive scope' and the page of vibe_web drive with it, so both move alike. All functions belong to the thread
/// that spins the global queue of the node.
class ManualDrive {
 public:
  /// @param name  of the part of the program that presses buttons
  explicit ManualDrive(const std::string& name);
  ~ManualDrive();
  ManualDrive(const ManualDrive&) = delete;
  ManualDrive& operator=(const ManualDrive&) = delete;

  /// Begins where the joints of the simulator are.
  /// @param name_space  of the simulator; empty: that of the node. An invalid one is told as trouble.
  void start(const std::string& name_space);
  /// Releases everything and gives the buttons back; call tick() until isSilent().
  void stop();
  bool isSilent() const;  ///< stopped, and the buttons are given back; joints may still brake

  void setSpeeds(const DriveSpeeds& speeds);  ///< of keys and mouse, from now on
  /// See ScopeDrive::keyDown(). @param key  see drive_keys.hpp
  void keyDown(int key);
  /// See ScopeDrive::keyUp(). @param key  see drive_keys.hpp
  void keyUp(int key);
  /// All keys come up, as when the window loses the focus; moving joints brake.
  void releaseAll();
  /// See ScopeDrive::displace() [m] or [rad].
  void displace(int joint, double by);

  /// Ten times a second.
  void tick();

  DriveView view() const;  ///< as of now

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vibe::operating
