#include "protocol/frame_message.hpp"

#include <algorithm>
#include <limits>

#include "protocol/byte_writer.hpp"

namespace vibe::web {

namespace {

constexpr float kSteps = 65535;

struct Box {
  std::array<float, 3> lowest{}, step{};
};

Box boxAround(const std::vector<float>& positions) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::max());
  high.fill(std::numeric_limits<float>::lowest());
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], positions[i + k]);
      high[k] = std::max(high[k], positions[i + k]);
    }
  Box box;
  for (std::size_t k = 0; k < 3 && !positions.empty(); ++k) {
    box.lowest[k] = low[k];
    box.step[k] = (high[k] - low[k]) / kSteps;
  }
  return box;
}

}  // namespace

Bytes encodeFrame(const FrameContent& content, const std::vector<float>& positions) {
  const Box box = boxAround(positions);
  ByteWriter writer(Kind::Frame, 80 + 4 * content.joints.size() + 2 * positions.size());
  const auto joints = static_cast<std::uint8_t>(std::min<std::size_t>(content.joints.size(), 255));
  writer.put(joints);
  writer.put(std::uint16_t{0});
  writer.put(content.revision);
  writer.put(content.time);
  writer.put(content.smoke);
  writer.put(static_cast<std::uint32_t>(positions.size() / 3));
  writer.putAll(box.lowest.data(), 3);
  writer.putAll(box.step.data(), 3);
  writer.putAll(content.wrench.data(), 6);
  writer.putAll(content.joints.data(), joints);
  std::vector<std::uint16_t> places(positions.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t k = i % 3;
    const float steps = box.step[k] > 0 ? (positions[i] - box.lowest[k]) / box.step[k] : 0;
    places[i] = static_cast<std::uint16_t>(std::clamp(steps + 0.5F, 0.0F, kSteps));
  }
  writer.putAll(places.data(), places.size());
  return writer.take();
}

}  // namespace vibe::web
