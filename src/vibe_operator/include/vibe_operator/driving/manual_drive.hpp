#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vibe_operator/driving/button_sender.hpp"
#include "vibe_operator/driving/scope_sender.hpp"

namespace vibe::operating {

/// Drives the scope and the suturing device with keys: publishes scope/servo_jp and
/// suturing_device/input/joint_states in a thread of its own, and scope/buttons while nobody else presses them. The
/// tool 'Drive scope' and the page of vibe_web drive with it, so both move alike. All functions belong to the thread
/// that spins the global queue of the node.
class ManualDrive {
 public:
  /// @param name  of the part of the program that presses buttons
  explicit ManualDrive(const std::string& name);

  /// Begins where the joints of the simulator are.
  /// @param name_space  of the simulator; empty: that of the node. An invalid one is told as trouble.
  void start(const std::string& name_space);
  /// Releases everything and gives the buttons back; call tick() until isSilent().
  void stop();
  /// Stopped, and the buttons are given back; joints may still brake.
  bool isSilent() const { return !active_ && !buttons_.closing(); }

  void setSpeeds(const DriveSpeeds& speeds) { sender_.setSpeeds(speeds); }  ///< of keys and mouse, from now on
  /// See ScopeDrive::keyDown(). @param key  see drive_keys.hpp
  void keyDown(int key);
  /// See ScopeDrive::keyUp(). @param key  see drive_keys.hpp
  void keyUp(int key);
  /// All keys come up, as when the window loses the focus; moving joints brake.
  void releaseAll();
  /// See ScopeDrive::displace() [m] or [rad].
  void displace(int joint, double by) { sender_.displace(joint, by); }

  /// Ten times a second.
  void tick();

  DriveView view() const;  ///< as of now

 private:
  void passButtons();

  ScopeSender sender_;
  ButtonSender buttons_;
  bool active_ = false;
  std::vector<std::pair<int, bool>> changes_;  // of keys, not passed on yet
  std::string name_space_trouble_;
};

}  // namespace vibe::operating
