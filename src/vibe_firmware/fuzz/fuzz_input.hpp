#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace vibe_firmware {

/// Ends the fuzzer with a finding unless the condition holds.
inline void require(bool condition) {
  if (!condition) std::abort();
}

/// Reads numbers from the bytes that the fuzzer has made up; zeros after their end.
class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  bool empty() const { return left_ == 0; }
  std::uint8_t byte() { return left_ == 0 ? 0 : (--left_, *data_++); }
  std::uint16_t word() {
    const int low = byte();
    return static_cast<std::uint16_t>(low | byte() << 8);
  }
  void fill(std::uint8_t* bytes, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) bytes[i] = byte();
  }
  /// Bytes in memory of exactly their size, so that the sanitizer sees every access beyond it.
  std::vector<std::uint8_t> bytes(std::size_t count) {
    std::vector<std::uint8_t> result(count);
    for (std::uint8_t& value : result) value = byte();
    return result;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace vibe_firmware
