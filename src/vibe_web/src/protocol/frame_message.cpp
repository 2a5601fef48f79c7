#include "protocol/frame_message.hpp"

#include <algorithm>

#include "protocol/byte_writer.hpp"
#include "protocol/place_box.hpp"

namespace vibe::web {

Bytes encodeFrame(const FrameContent& content, const std::vector<float>& positions) {
  const PlaceBox box(positions.size() / 3, [&](std::size_t i) { return &positions[3 * i]; });
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
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = box.place(positions[i], i % 3);
  writer.putAll(places.data(), places.size());
  return writer.take();
}

}  // namespace vibe::web
