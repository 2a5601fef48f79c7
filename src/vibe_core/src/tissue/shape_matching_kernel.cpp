#include "tissue/shape_matching_kernel.hpp"

#include "tissue/shape_matching_kernel_impl.hpp"

namespace vibe {

void sweepClustersSse2(const ClusterSweep& sweep, int first_group, int last_group) {
  Kernel<xsimd::sse2>::sweep(sweep, first_group, last_group);
}

namespace {
bool haveAvx2() {
  return __builtin_cpu_supports("avx2") != 0;
}
}  // namespace

ClusterSweepFunction chooseClusterSweep() {
  return haveAvx2() ? sweepClustersAvx2 : sweepClustersSse2;
}

const char* clusterSweepName() {
  return haveAvx2() ? "avx2" : "sse2";
}

}  // namespace vibe
