#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace vibe {

/// Resource limits of a helper program.
struct WorkLimits {
  unsigned seconds = 30;                      ///< of wall time [s]
  std::size_t memory = std::size_t{4} << 30;  ///< of address space, and of its output [bytes]
};

/// Runs a helper program and returns its standard output. The program is spawned, not forked, so a caller with threads
/// may do this at any time. It gets no standard input, no open files of the caller and default signal handlers. Its
/// standard error is discarded. The time limit is enforced here; the program itself enforces the memory limit.
/// @throws Error, as a clause without a full stop, if the program cannot be started, takes too long, writes too much or
///         does not exit normally with status 0
std::string runHelper(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      const WorkLimits& limits);

}  // namespace vibe
