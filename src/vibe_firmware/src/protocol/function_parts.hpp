#pragma once
#include <cstring>

#include "vibe_firmware/protocol/control_endpoint.hpp"
#include "vibe_firmware/protocol/reports.hpp"

// Parts that the functions of both devices have.

namespace vibe_firmware {

inline Bytes textBytes(const char* text) {
  return {reinterpret_cast<const std::uint8_t*>(text), std::strlen(text)};
}

/// Strings 1 to 3 of the device descriptor.
inline Bytes deviceString(std::uint8_t index, const char* product, const char* serial) {
  switch (index) {
    case 1:
      return textBytes("ViBE");
    case 2:
      return textBytes(product);
    case 3:
      return textBytes(serial);
    default:
      return {};
  }
}

/// @return size of the report; 0: it does not fit
template <std::size_t kSize, typename Report>
std::size_t packInto(const Report& report, std::uint8_t* bytes, std::size_t capacity) {
  if (capacity < kSize) return 0;
  std::uint8_t packed[kSize];
  pack(report, packed);
  std::memcpy(bytes, packed, kSize);
  return kSize;
}

}  // namespace vibe_firmware
