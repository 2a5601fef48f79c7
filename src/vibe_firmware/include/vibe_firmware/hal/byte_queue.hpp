#pragma once
#include <cstddef>
#include <cstdint>

namespace vibe_firmware {

/// Bytes that wait for a transmitter, first in, first out. Not for use from interrupts.
template <std::size_t kCapacity>
class ByteQueue {
 public:
  /// All or nothing. @return whether there was room
  bool put(const void* bytes, std::size_t size) {
    if (size > kCapacity - size_) return false;
    for (std::size_t i = 0; i < size; ++i)
      bytes_[(first_ + size_++) % kCapacity] = static_cast<const std::uint8_t*>(bytes)[i];
    return true;
  }

  bool empty() const { return size_ == 0; }

  /// Only if it is not empty.
  std::uint8_t take() {
    const std::uint8_t byte = bytes_[first_];
    first_ = (first_ + 1) % kCapacity;
    --size_;
    return byte;
  }

 private:
  std::uint8_t bytes_[kCapacity];
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace vibe_firmware
