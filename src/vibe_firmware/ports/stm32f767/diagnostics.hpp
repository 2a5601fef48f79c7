#pragma once
#include <cstdint>

#include "vibe_firmware/hal/byte_queue.hpp"

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

/// Lines on USART3, 115200 baud: the virtual serial port of the Nucleo's debugger. For people; nothing reads it.
class Diagnostics {
 public:
  Diagnostics();

  /// Queues a text; one that does not fit is dropped.
  void write(const char* text);

  /// Sends a character if the transmitter is free.
  void poll();

 private:
  ByteQueue<128> queue_;
};

/// Why the board has started, in words; RM0410, RCC_CSR. Clears the reason.
const char* resetReason();

}  // namespace vibe_firmware::stm32
