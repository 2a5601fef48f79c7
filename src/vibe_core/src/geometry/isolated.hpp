#pragma once
#include <cstddef>
#include <functional>
#include <string>

namespace vibe {

/// How much a piece of work may use.
struct WorkLimits {
  unsigned seconds = 30;                      ///< of wall time [s]
  std::size_t memory = std::size_t{4} << 30;  ///< of address space [bytes]; not applied under a sanitizer
};

/// Runs work on untrusted input in a child process and returns what it returned, so that whatever the input does to
/// it (endless loop, failed assertion, invalid memory) cannot harm the caller.
/// @throws std::exception's text as Error if the work threw; Error if the process ended in another way.
std::string runIsolated(const std::function<std::string()>& work, const WorkLimits& limits);

}  // namespace vibe
