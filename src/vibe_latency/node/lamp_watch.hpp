#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>

struct _XDisplay;  // of Xlib, whose macros must not meet Eigen

namespace vibe::latency {

/// State of a pixel of the display LatencyLamp: green is lit, magenta is not; any other colour is no lamp.
/// @param pixel  0xRRGGBB
std::optional<bool> lampState(unsigned long pixel);

/// Watches the lamp that the display LatencyLamp of rviz draws, on a screen with 24 bits per pixel: finds it, then
/// reads its middle pixel every millisecond, in a thread of its own.
class LampWatch {
 public:
  /// The lamp has changed. @param wall  time of the reading [ns]
  using Callback = std::function<void(std::int64_t wall, bool lit)>;

  /// @throws Error if there is no screen, or one of another depth
  explicit LampWatch(Callback changed);
  ~LampWatch();
  LampWatch(const LampWatch&) = delete;
  LampWatch& operator=(const LampWatch&) = delete;

  bool isFound() const { return found_; }

 private:
  Callback changed_;
  _XDisplay* display_;
  unsigned long root_;  // window
  int x_ = 0, y_ = 0;   // of the lamp's middle [pixels]
  std::atomic<bool> found_{false}, stopping_{false};
  std::thread thread_;

  void run();
  void find();
  std::optional<bool> readLamp();
};

}  // namespace vibe::latency
