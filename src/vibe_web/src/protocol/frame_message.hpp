#pragma once

#include <array>
#include <vector>

#include "protocol/message_kind.hpp"

namespace vibe::web {

/// The organ and the tool at one moment.
struct FrameContent {
  std::uint32_t revision = 0;     ///< of the topology
  double time = 0;                ///< of the sample [s]
  float smoke = 0;                ///< its extinction [1/m]
  std::array<float, 6> wrench{};  ///< of the tissue on the tool, in scope_tip [N], [N m]
  std::vector<float> joints;      ///< in the order of the scene's list, at most 255 [m], [rad]
};

/// Message Kind::Frame:
///   u8 kind, u8 joints, u16 0, u32 revision, f64 time, f32 smoke, u32 particles, f32 lowest[3], f32 step[3],
///   f32 wrench[6], f32 joint[joints], u16 place[3 particles].
/// Lowest, step and place are those of a PlaceBox around all particles.
/// @param positions  x y z per particle, finite [m]
Bytes encodeFrame(const FrameContent& content, const std::vector<float>& positions);

}  // namespace vibe::web
