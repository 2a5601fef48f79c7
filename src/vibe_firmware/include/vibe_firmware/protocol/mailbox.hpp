#pragma once

#include <atomic>
#include <cstdint>

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

/// The newest value of the control interrupt, for the main loop of the same processor, whole at all times: the main
/// loop reads again if the interrupt came in between. Two threads are not an interrupt: they need a lock around both.
template <typename T>
class Published {
 public:
  /// Interrupt.
  void publish(const T& value) {
    value_ = value;
    std::atomic_signal_fence(std::memory_order_seq_cst);
    number_.store(number_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }

  /// Main loop. @return number of the value: how many have been published, 0: none yet; wraps
  std::uint32_t read(T& value) const {
    std::uint32_t number = 0;
    do {
      number = number_.load(std::memory_order_relaxed);
      std::atomic_signal_fence(std::memory_order_seq_cst);
      value = value_;
      std::atomic_signal_fence(std::memory_order_seq_cst);
    } while (number != number_.load(std::memory_order_relaxed));
    return number;
  }

 private:
  T value_{};
  std::atomic<std::uint32_t> number_{0};
};

}  // namespace vibe_firmware
