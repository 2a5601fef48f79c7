#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

namespace vibe::vision {

/// Reads little-endian numbers, on any machine. Reading beyond the end gives 0 and makes ok() false.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), left_(size) {}

  template <class Unsigned>
  Unsigned getUnsigned() {
    if (left_ < sizeof(Unsigned)) ok_ = false;
    if (!ok_) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i) value |= static_cast<std::uint64_t>(bytes_[i]) << (8 * i);
    bytes_ += sizeof(Unsigned);
    left_ -= sizeof(Unsigned);
    return static_cast<Unsigned>(value);
  }
  double getDouble() {
    const auto bits = getUnsigned<std::uint64_t>();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  float getFloat() {
    const auto bits = getUnsigned<std::uint32_t>();
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  /// A byte that must be 0 or 1.
  bool getFlag() {
    const auto value = getUnsigned<std::uint8_t>();
    if (value > 1) ok_ = false;
    return value == 1;
  }
  bool ok() const { return ok_; }
  bool atEnd() const { return left_ == 0; }

 private:
  const std::uint8_t* bytes_;
  std::size_t left_;
  bool ok_ = true;
};

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
