#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace vibe::web {

constexpr std::size_t kMaxCommand = 128;  ///< longest command [bytes]
constexpr std::size_t kMaxKeys = 16;      ///< held at the same time
constexpr std::size_t kAxes = 7;          ///< joints, in the order of StepInput

constexpr std::size_t kViewerBodies = 3;    ///< head, left hand, right hand
constexpr std::size_t kViewerButtons = 10;  ///< of the left hand, then of the right: trigger, grip, stick, lower, upper
constexpr float kFarthest = 100;            ///< from the organ [m]

/// Head and hands of the person who drives in a headset. Of a body x is ahead, y to the left and z up.
struct ViewerState {
  using Pose = std::array<float, 7>;  ///< position [m] and quaternion x, y, z, w in the world of the simulator
  std::array<std::optional<Pose>, kViewerBodies> poses;  ///< of those that are there
  std::array<bool, kViewerButtons> buttons{};            ///< true while pressed
  std::array<double, 4> sticks{};                        ///< left and right: to the right, ahead, -1 to 1
};

/// What a page asks for. Any bytes may come, so nothing here is trusted before decodeCommand() has looked at it.
struct Command {
  enum class Kind : std::uint8_t { Rate = 1, Take, GiveBack, Drive, Replay, Ping, Drawn, Viewer };
  Kind kind = Kind::Ping;

  int rate = 0;   ///< Rate: frames per second, 1 to 60
  int drawn = 0;  ///< Drawn: frames that the page has done with since it last said so; at first 0: it will say so

  // Drive: all that is held now. It says who was allowed to drive and which of its messages this is, so that none is
  // obeyed twice or from another connection.
  std::uint32_t grant = 0, number = 0;
  std::array<double, kAxes> axes{};  ///< share of the speed of a key, -1 to 1, by joint
  std::vector<int> keys;             ///< as in the key table of the scene

  // Replay: what vibe_msgs/ReplayCommand says.
  bool play = false, seek = false;
  double speed = 1;  ///< 0.01 to 100
  double time = 0;   ///< to go to with `seek` [s]

  std::array<std::uint8_t, 8> ping{};

  ViewerState viewer;
};

/// The command that these bytes are; nothing if they are none. Layouts, little-endian:
///   1 Rate      u8 1, u8 rate
///   2 Take      u8 2
///   3 GiveBack  u8 3
///   4 Drive     u8 4, u8 keys, u16 0, u32 grant, u32 number, i16 axis[7] in 1/32767, u16 0, u32 key[keys]
///   5 Replay    u8 5, u8 play (1) and seek (2), u8 0[6], f64 speed, f64 time
///   6 Ping      u8 6, u8 0[7], u8 any[8]
///   7 Drawn     u8 7, u8 frames
///   8 Viewer    u8 8, u8 which are there (1, 2, 4), u16 buttons, i16 stick[4] in 1/32767, f32 pose[3][7]
std::optional<Command> decodeCommand(const std::uint8_t* bytes, std::size_t size);

}  // namespace vibe::web
