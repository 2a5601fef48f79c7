#include "diagnostics.hpp"

#include "clocks.hpp"
#include "registers.hpp"

namespace vibe_firmware::stm32 {

Diagnostics::Diagnostics() {
  usart3().brr = (kApb1Clock + 115200 / 2) / 115200;
  usart3().cr1 = bit(0) | bit(3);  // on, transmitter
}

void Diagnostics::write(const char* text) {
  while (*text != 0) put(*text++);
}

void Diagnostics::write(std::uint32_t number) {
  char digits[11];
  char* first = digits + sizeof digits - 1;
  *first = 0;
  do {
    *--first = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number > 0);
  write(first);
}

void Diagnostics::put(char character) {
  if (size_ == kCapacity) return;
  queue_[(first_ + size_++) % kCapacity] = character;
}

void Diagnostics::poll() {
  constexpr std::uint32_t kTransmitterEmpty = bit(7);
  if (size_ == 0 || !(usart3().isr & kTransmitterEmpty)) return;
  usart3().tdr = static_cast<std::uint8_t>(queue_[first_]);
  first_ = (first_ + 1) % kCapacity;
  --size_;
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
