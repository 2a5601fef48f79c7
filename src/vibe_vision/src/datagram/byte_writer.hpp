#pragma once
#include <cstdint>
#include <cstring>
#include <vector>

namespace vibe::vision {

/// Appends numbers as little-endian bytes, on any machine.
class ByteWriter {
 public:
  template <class Unsigned>
  void putUnsigned(Unsigned value) {
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
      bytes_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }
  void putDouble(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    putUnsigned(bits);
  }
  void putFloat(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    putUnsigned(bits);
  }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace vibe::vision
