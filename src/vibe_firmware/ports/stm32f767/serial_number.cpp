#include "serial_number.hpp"

#include "registers.hpp"

namespace vibe_firmware::stm32 {

const char* serialNumber() {
  constexpr std::uintptr_t kUniqueId = 0x1FF0F420;  // 96 bits
  static char text[25];
  char* next = text;
  for (std::uintptr_t word = 0; word < 3; ++word) {
    const std::uint32_t value = at<Register>(kUniqueId + 4 * word);
    for (int shift = 28; shift >= 0; shift -= 4) *next++ = "0123456789ABCDEF"[value >> shift & 15];
  }
  return text;
}

}  // namespace vibe_firmware::stm32
