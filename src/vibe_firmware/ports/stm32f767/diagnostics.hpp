#pragma once
#include <cstddef>
#include <cstdint>

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

/// Lines on USART3, 115200 baud: the virtual serial port of the Nucleo's debugger. For people; nothing reads it.
class Diagnostics {
 public:
  Diagnostics();

  /// Queues a text; what does not fit is dropped.
  void write(const char* text);
  void write(std::uint32_t number);

  /// Sends a character if the transmitter is free.
  void poll();

 private:
  static constexpr std::size_t kCapacity = 128;

  void put(char character);

  char queue_[kCapacity];
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

/// Why the board has started, in words; RM0410, RCC_CSR. Clears the reason.
const char* resetReason();

}  // namespace vibe_firmware::stm32
