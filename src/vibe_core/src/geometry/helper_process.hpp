#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace vibe {

/// How much a helper program may use.
struct WorkLimits {
  unsigned seconds = 30;                      ///< of wall time [s]
  std::size_t memory = std::size_t{4} << 30;  ///< of address space, and of what it may write [bytes]
};

/// Runs a helper program and returns what it writes to its standard output. The program is spawned, not forked, so
/// that a caller with threads may do this at any time. It gets no standard input, no open file of the caller, default
/// signal handlers, and its messages on standard error are dropped. The limit on time is enforced here; the program
/// itself applies the limit on memory.
/// @throws Error, as a clause without a full stop, if the program cannot be started, takes too long, writes too much
///         or does not end by itself with status 0
std::string runHelper(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      const WorkLimits& limits);

}  // namespace vibe
