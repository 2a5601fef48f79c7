#include "protocol/viewer_message.hpp"

#include "protocol/byte_writer.hpp"

namespace vibe::web {

Bytes encodeViewer(const ViewerState& viewer) {
  ByteWriter writer(Kind::Viewer, 88);
  std::uint8_t present = 0;
  for (std::size_t k = 0; k < kViewerBodies; ++k)
    if (viewer.poses[k]) present |= static_cast<std::uint8_t>(1U << k);
  writer.put(present);
  writer.put(std::uint16_t{0});
  for (const auto& pose : viewer.poses) {
    const ViewerState::Pose numbers = pose.value_or(ViewerState::Pose{});
    writer.putAll(numbers.data(), numbers.size());
  }
  return writer.take();
}

}  // namespace vibe::web
