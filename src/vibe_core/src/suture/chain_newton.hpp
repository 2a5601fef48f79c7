#pragma once
#include "suture/hanging_thread.hpp"

namespace vibe::detail {

void fitScratch(int links, HangingThreadScratch& scratch);

/// Finds the positions and tensions with
///   (1 + drag h) m_j / h^2 (x_j - target_j) = T_j d_j - T_{j-1} d_{j-1}   at every node that is not held,
///   |x_{k+1} - x_k| = l (1 + T_k / EA)                                       for every link,
/// starting from those of state, by Newton's method. Its matrix is quasi-definite where no link pushes, and is made so
/// where one does (that part of its stiffness is left out): a block factor without pivoting always exists.
/// @return  whether it converged; state is what was reached
bool settleChain(const HangingThreadModel& model, const ThreadEnds& ends, double h, HangingThread& state,
                 HangingThreadScratch& scratch);

}  // namespace vibe::detail
