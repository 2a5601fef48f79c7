#pragma once

namespace vibe {

/// Looks at how the calling thread computes, which libraries of a process may have changed: results are those of
/// rounding to nearest with small numbers kept. Takes some nanoseconds.
/// @throws Error if the thread rounds otherwise, or takes small numbers for 0
void checkFloatingPoint();

}  // namespace vibe
