#include "tissue/shape_matching_kernel.hpp"

#include "vibe_core/common/arithmetic.hpp"

namespace vibe {

ClusterSweepFunction chooseClusterSweep() {
  return instructionSet() == InstructionSet::Sse2 ? sweepClustersSse2 : sweepClustersAvx2;
}

}  // namespace vibe
