#pragma once
#include <diagnostic_updater/diagnostic_updater.h>

#include "vibe_hardware/driver/device_driver.hpp"
#include "vibe_hardware/driver/haptic_driver.hpp"

namespace vibe::hardware {

/// What a device's entry on /diagnostics compares with its last one.
struct DiagnosticMemory {
  StreamCounts counts;
  HapticStatistics haptic;
};

/// Fills the entry of a device: ERROR if it is unusable or silent; WARN if it is absent, or if since the last entry
/// reports were lost or wrong or parameters refused, or the rate is low.
/// @param haptic           null for the input device
/// @param rejected         messages on haptic/parameters that could not be used
void fillDiagnostics(const DeviceStatistics& device, const HapticStatistics* haptic, std::uint64_t rejected,
                     DiagnosticMemory& memory, diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace vibe::hardware
