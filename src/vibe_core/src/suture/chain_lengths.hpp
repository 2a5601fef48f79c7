#pragma once
#include "suture/hanging_thread.hpp"

namespace vibe::detail {

/// Restores the length of every link without forces, for an end that moved so far in one sub-step that no equilibrium
/// is found. Nodes follow their neighbours, from one held end to the other and back (FABRIK: Aristidou & Lasenby,
/// Graphical Models 2011;73:243). If the held ends are farther apart than the thread length, the chain becomes straight
/// and uniformly stretched.
void restoreLengths(const HangingThreadModel& model, const ThreadEnds& ends, Eigen::Matrix3Xd& position);

}  // namespace vibe::detail
