#pragma once
#include "suture/hanging_thread.hpp"

namespace vibe::detail {

void fitScratch(int links, HangingThreadScratch& scratch);

/// Solves for the positions and tensions with
///   (1 + drag h) m_j / h^2 (x_j - target_j) = T_j d_j - T_{j-1} d_{j-1}   at every free node,
///   |x_{k+1} - x_k| = l (1 + T_k / EA)                                       for every link,
/// starting from those of state, by Newton's method. Its matrix is quasi-definite if no link is in compression, and is
/// made so otherwise (that part of the stiffness is left out). A block factorisation without pivoting therefore always
/// exists.
/// @return  whether it converged; state holds the last iterate
bool settleChain(const HangingThreadModel& model, const ThreadEnds& ends, double h, HangingThread& state,
                 HangingThreadScratch& scratch);

}  // namespace vibe::detail
