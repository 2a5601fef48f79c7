#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace vibe::web {

/// What a message to a page is: its first byte. Of each kind a client gets the newest only, so each says all there is
/// of it.
enum class Kind : std::uint8_t {
  Scene = 1,      ///< text: names, keys, parts of the robot
  Topology = 2,   ///< topology_message.hpp
  Frame = 3,      ///< frame_message.hpp
  Folds = 4,      ///< wall_look.hpp
  Heat = 5,       ///< wall_look.hpp
  Sutures = 6,    ///< suture_stream.hpp
  State = 7,      ///< text: phase, gas, counts, measures
  Events = 8,     ///< text: the last events with their numbers
  Replay = 9,     ///< text: where a recording stands
  Operator = 10,  ///< text: whether anybody drives, and why not
  Pong = 11,  ///< to one client: u8 kind, u8 0[7], the eight bytes of its ping, f64 time of the server since 1970 [s]
  Refusal = 12,  ///< text, to one client: one sentence
  Grant = 13,    ///< text, to one client: it drives, and what its drive messages have to name
  Blood = 14,    ///< shape_message.hpp
  Threads = 15,  ///< shape_message.hpp: thread, T-tags and cinches as the endoscope sees them
  Health = 16,   ///< text: what is wrong with what is heard of the session
  Viewer = 17    ///< viewer_message.hpp: head and hands of the one who drives in a headset
};
constexpr std::size_t kKinds = 18;  ///< one more than the largest number

using Bytes = std::vector<std::uint8_t>;
using SharedBytes = std::shared_ptr<const Bytes>;

}  // namespace vibe::web
