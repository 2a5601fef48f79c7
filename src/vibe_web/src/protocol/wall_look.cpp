#include "protocol/wall_look.hpp"

#include <algorithm>

#include "protocol/byte_writer.hpp"

namespace vibe::web {

namespace {

constexpr float kMaxBrowned = 3;  // grade 3, brown

std::uint8_t byteOf(float value, float most) {
  return static_cast<std::uint8_t>(255 * std::clamp(value / most, 0.0F, 1.0F) + 0.5F);
}

void begin(ByteWriter& writer, std::uint32_t revision) {
  for (int k = 0; k < 3; ++k) writer.put(std::uint8_t{0});
  writer.put(revision);
}

std::optional<Bytes> ifChanged(Bytes message, Bytes& last) {
  if (message == last) return std::nullopt;
  last = message;
  return message;
}

}  // namespace

WallLook::WallLook(const graphics::TissueMesh& mesh, const graphics::MucosaMap& map)
    : revision_(mesh.revision), fold_height_(mesh, map), colours_(mesh), scars_(mesh), smoke_(mesh) {}

void WallLook::see(const graphics::TissueFrame& frame) {
  smoke_.see(frame);
  scars_.see(frame);
}

std::optional<Bytes> WallLook::folds(const graphics::TissueFrame& frame) {
  const std::vector<float>& heights = fold_height_.update(frame.positions);
  ByteWriter writer(Kind::Folds, heights.size() + 8);
  begin(writer, revision_);
  for (const float height : heights) writer.put(byteOf(height, graphics::kTallestFold));
  return ifChanged(writer.take(), last_folds_);
}

std::optional<Bytes> WallLook::heat(const graphics::TissueFrame& frame) {
  colours_.update(frame);
  const std::vector<float> browned = scars_.browned();
  std::vector<std::uint32_t> vertices;
  Bytes effects, brown;
  for (std::size_t v = 0; v < colours_.colours().size(); ++v) {
    const auto effect = static_cast<std::uint8_t>(colours_.colours()[v] >> 24);
    if (effect == 255) continue;
    vertices.push_back(static_cast<std::uint32_t>(v));
    effects.push_back(effect);
    brown.push_back(byteOf(v < browned.size() ? browned[v] : 0, kMaxBrowned));
  }
  ByteWriter writer(Kind::Heat, 12 + 6 * vertices.size());
  begin(writer, revision_);
  writer.put(static_cast<std::uint32_t>(vertices.size()));
  writer.putAll(vertices.data(), vertices.size());
  writer.putAll(effects.data(), effects.size());
  writer.putAll(brown.data(), brown.size());
  return ifChanged(writer.take(), last_heat_);
}

}  // namespace vibe::web
