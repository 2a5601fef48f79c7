#include "tissue/shape_matching_kernel_impl.hpp"

namespace vibe {

void sweepClustersAvx2(const ClusterSweep& sweep, int first_group, int last_group) {
  Kernel<xsimd::avx2>::sweep(sweep, first_group, last_group);
}

}  // namespace vibe
