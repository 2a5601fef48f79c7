#pragma once
#include <string>

namespace vibe::hardware {

/// Throws what a failed request for a feature report means: DeviceGone, ReportRejected or NoAnswer.
/// @param error  errno of the request
/// @param what   "feature report 3 cannot be read"
[[noreturn]] void failTransfer(const std::string& path, int error, const std::string& what);

}  // namespace vibe::hardware
