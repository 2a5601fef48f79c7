#pragma once
#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/suture/suture.hpp"

namespace vibe {

/// Shortest length of a segment, which the solver keeps between bites that have met. Drawing more out of a segment
/// would have no effect [m].
constexpr double kMinSegment = kMinThread;

/// Draws thread out of a set: out of the segment at the cinch until it is as short as kMinSegment, then out of the
/// next.
/// @param amount  [m]
/// @return amount drawn; less than `amount` if every segment is as short as it can be [m]
double drawThread(double amount, Suture& suture);

/// Tension at the cinch: the maximum over the segments from the cinch to the first one whose bites have not met (which
/// is longer than kMinSegment). The tissue cannot stretch a segment between bites that touch, so the tension of such a
/// segment alone does not show how hard the thread is drawn [N].
double cinchTension(const Suture& suture);

}  // namespace vibe
