#pragma once
#include "suture/hanging_thread.hpp"

namespace vibe::detail {

/// Gives every link its length again without forces, for when an end was moved so far in one sub-step that equilibrium
/// is not found: nodes follow their neighbours, from one held end to the other and back (FABRIK: Aristidou & Lasenby,
/// Graphical Models 2011;73:243). Held ends further apart than the thread make it straight and even.
void restoreLengths(const HangingThreadModel& model, const ThreadEnds& ends, Eigen::Matrix3Xd& position);

}  // namespace vibe::detail
