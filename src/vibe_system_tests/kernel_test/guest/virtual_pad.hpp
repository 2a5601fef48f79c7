#pragma once
#include <linux/uinput.h>

#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace vibe::hardware {

/// A gamepad that the kernel makes for this program (uinput), with two sticks, buttons, rumble and spring. It shows
/// what a reader of the pad asks of its motors.
class VirtualPad {
 public:
  static constexpr int kAxisLimit = 32767;

  explicit VirtualPad(const std::string& name);  ///< @throws std::runtime_error
  ~VirtualPad();                                 ///< unplugs it
  VirtualPad(const VirtualPad&) = delete;
  VirtualPad& operator=(const VirtualPad&) = delete;

  /// Sends an event, and the end of the report.
  void send(int type, int code, int value);

  /// The effect of this type (FF_RUMBLE, FF_SPRING) that was uploaded last and is being played.
  /// @return whether there is one
  bool playing(int type, ff_effect& effect) const;

  /// Path of its event node, once there is one.
  std::string eventNode() const;

 private:
  void declare(const std::string& name);
  void answerRequests();
  void upload(int request);
  void erase(int request);
  void write(int type, int code, int value);

  int file_;
  std::atomic<bool> ends_{false};
  mutable std::mutex mutex_;  // of the next two
  std::map<int, ff_effect> effects_;
  std::map<int, bool> playing_;
  std::thread thread_;  // of answerRequests(): the kernel lets a reader wait until an upload is answered
};

}  // namespace vibe::hardware
