#include "tissue/shape_matching_kernel.hpp"

#include "tissue/shape_matching_kernel_impl.hpp"
#include "vibe_core/common/arithmetic.hpp"

namespace vibe {

void sweepClustersSse2(const ClusterSweep& sweep, int first_group, int last_group) {
  Kernel<xsimd::sse2>::sweep(sweep, first_group, last_group);
}

ClusterSweepFunction chooseClusterSweep() {
  return instructionSet() == InstructionSet::Sse2 ? sweepClustersSse2 : sweepClustersAvx2;
}

}  // namespace vibe
