#pragma once
#include <atomic>

namespace vibe_firmware {

/// Hands values from the main loop to the control interrupt of the same processor, whole or not at all. The interrupt
/// may come between any two instructions of put(), never the other way round. A value that was not taken is replaced.
/// Two threads are not an interrupt: they need a lock around both functions.
template <typename T>
class Mailbox {
 public:
  /// Main loop.
  void put(const T& value) {
    full_.store(false, std::memory_order_relaxed);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    value_ = value;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    full_.store(true, std::memory_order_relaxed);
  }

  /// Interrupt. @return whether there was a new value
  bool take(T& value) {
    if (!full_.load(std::memory_order_relaxed)) return false;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    value = value_;
    full_.store(false, std::memory_order_relaxed);
    return true;
  }

 private:
  T value_{};
  std::atomic<bool> full_{false};
};

}  // namespace vibe_firmware
