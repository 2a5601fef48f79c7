#pragma once
#include <array>
#include <cstdint>

namespace vibe_firmware {

constexpr std::array<std::uint8_t, 3> kFirmwareVersion = {0, 1, 0};  ///< major, minor, patch: that of package.xml

}  // namespace vibe_firmware
