#include "diagnostics.hpp"

#include <cstring>

#include "clocks.hpp"
#include "registers.hpp"

namespace vibe_firmware::stm32 {

Diagnostics::Diagnostics() {
  usart3().brr = (kApb1Clock + 115200 / 2) / 115200;
  usart3().cr1 = bit(0) | bit(3);  // on, transmitter
}

void Diagnostics::write(const char* text) {
  queue_.put(text, std::strlen(text));
}

void Diagnostics::poll() {
  constexpr std::uint32_t kTransmitterEmpty = bit(7);
  if (!queue_.empty() && (usart3().isr & kTransmitterEmpty)) usart3().tdr = queue_.take();
}

const char* resetReason() {
  const std::uint32_t status = rcc().csr;
  setBits(rcc().csr, bit(24));  // RMVF
  if (status & bit(29)) return "watchdog";
  if (status & bit(28)) return "software";
  if (status & bit(27)) return "power";
  return "reset pin";
}

}  // namespace vibe_firmware::stm32
