#pragma once

#include <string>

#include "vibe_hardware/hid/file_descriptor.hpp"

namespace vibe::hardware {

/// Connects to a socket file without waiting. @return empty if nobody serves it; errno says why
FileDescriptor connectTo(const std::string& path);

/// Serves a new socket file. A file that is left over from an earlier server is replaced.
/// @throws std::runtime_error with the remedy: the path is too long, in use, or cannot be made
FileDescriptor listenAt(const std::string& path);

/// Waits until something can be read or the other side has closed. @param seconds  negative: for ever
/// @return whether it can
bool waitReadable(int file, double seconds);

/// Throws what a failed request for a feature report means: DeviceGone, ReportRejected or NoAnswer.
/// @param error  errno of the request
/// @param what   "feature report 3 cannot be read"
[[noreturn]] void failTransfer(const std::string& path, int error, const std::string& what);

}  // namespace vibe::hardware
