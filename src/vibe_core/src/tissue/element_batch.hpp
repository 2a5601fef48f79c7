#pragma once

#include <cstdint>

namespace vibe {

constexpr int kBatchLanes = 8;  ///< elements that a kernel evaluates at once

/// One number of each element of a batch.
struct alignas(32) BatchReals {
  float lane[kBatchLanes];
};
/// For each element of a batch, the start of a node's four numbers: 4 * node.
struct alignas(32) BatchOffsets {
  std::uint32_t lane[kBatchLanes];
};

}  // namespace vibe
