#include "semihosting.hpp"

#include <cstdint>
#include <cstring>

namespace vibe_firmware::semihosting {
namespace {

enum Operation : std::uint32_t { kOpen = 0x01, kWrite = 0x05, kRead = 0x06, kCommandLine = 0x15, kExit = 0x20 };
constexpr std::uint32_t kApplicationExit = 0x20026;

std::int32_t call(Operation operation, const void* parameters) {
  std::int32_t result;
  asm volatile(
      "mov r0, %1\n"
      "mov r1, %2\n"
      "bkpt 0xab\n"
      "mov %0, r0\n"
      : "=r"(result)
      : "r"(static_cast<std::uint32_t>(operation)), "r"(parameters)
      : "r0", "r1", "memory");
  return result;
}

std::uint32_t addressOf(const void* pointer) {
  return reinterpret_cast<std::uintptr_t>(pointer);
}

}  // namespace

void exit(int status) {
  const std::uint32_t parameters[] = {kApplicationExit, static_cast<std::uint32_t>(status)};
  call(kExit, parameters);
  for (;;) asm volatile("");
}

int open(const char* name, Mode mode) {
  const std::uint32_t parameters[] = {addressOf(name), static_cast<std::uint32_t>(mode), std::strlen(name)};
  return call(kOpen, parameters);
}

bool write(int handle, const void* bytes, std::size_t size) {
  const std::uint32_t parameters[] = {static_cast<std::uint32_t>(handle), addressOf(bytes), size};
  return call(kWrite, parameters) == 0;
}

bool read(int handle, void* bytes, std::size_t size) {
  auto* next = static_cast<std::uint8_t*>(bytes);
  while (size > 0) {
    const std::uint32_t parameters[] = {static_cast<std::uint32_t>(handle), addressOf(next), size};
    const auto left = static_cast<std::size_t>(call(kRead, parameters));
    if (left >= size) return false;
    next += size - left;
    size = left;
  }
  return true;
}

bool commandLine(char* text, std::size_t capacity) {
  const std::uint32_t parameters[] = {addressOf(text), capacity};
  return call(kCommandLine, parameters) == 0;
}

}  // namespace vibe_firmware::semihosting
