#pragma once
#include <cstdint>

#include "vibe_firmware/core/axis.hpp"
#include "vibe_firmware/protocol/reports.hpp"

// What firmware and plant exchange once per tick when they run in lock-step. Both sides are little-endian and lay these
// structs out alike; the assertions at the end make sure.

namespace vibe_firmware {

constexpr std::size_t kCosimData = 64;           ///< bytes of a control request's data stage, and of its answer
constexpr std::int32_t kNoControl = -1000;       ///< CosimReply::control_result without a control request
constexpr std::uint32_t kCosimPwmPeriod = 4320;  ///< as on STM32F767 [counts]

/// From the plant, at the beginning of a tick.
struct CosimRequest {
  std::uint32_t counter[kAxisCount]{};
  std::uint32_t index_counter[kAxisCount]{};
  std::uint32_t time_us = 0;
  std::uint16_t buttons = 0;
  std::uint8_t index = 0;         ///< bit per axis
  std::uint8_t stop = 0;          ///< not 0: end without running this tick
  std::uint8_t has_control = 0;   ///< not 0: a control request follows, for the main loop after this tick
  std::uint8_t request_type = 0;  ///< its setup packet
  std::uint8_t request = 0;
  std::uint8_t unused = 0;
  std::uint16_t value = 0;
  std::uint16_t length = 0;
  std::uint8_t data[kCosimData]{};
};

/// From the firmware, at the end of a tick.
struct CosimReply {
  std::uint32_t tick = 0;
  std::uint32_t entry_counts = 0;  ///< clock at the entry of the interrupt, 25 MHz; 0 on the host
  float torque[kAxisCount]{};
  std::uint32_t first[kAxisCount]{};   ///< compare values of the bridge inputs, of kCosimPwmPeriod
  std::uint32_t second[kAxisCount]{};  ///< the same of the second input
  float position[kAxisCount]{};        ///< from here: state of the control loop
  float velocity[kAxisCount]{};
  float energy[kAxisCount]{};
  std::int32_t control_result = kNoControl;  ///< of the control request that came with the tick before
  std::uint8_t response[kCosimData]{};
  std::uint8_t has_report = 0;  ///< an input report was sent since the tick before
  std::uint8_t report[kInputReportSize]{};
  std::uint8_t unused[3]{};
};

static_assert(sizeof(CosimRequest) == 96 && sizeof(CosimReply) == 156, "no padding");

}  // namespace vibe_firmware
