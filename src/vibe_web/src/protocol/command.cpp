#include "protocol/command.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace vibe::web {

namespace {

constexpr int kMaxRate = 60;                       // [Hz]
constexpr double kSlowest = 0.01, kFastest = 100;  // as vibe_player
constexpr double kLongest = 1e7;                   // of a recording [s]
constexpr std::uint32_t kLastKey = 0x01ffffff;     // of Qt::Key
constexpr std::size_t kDriveHead = 28;             // [bytes]
constexpr std::size_t kViewerHead = 12;            // [bytes]
constexpr float kUnit = 1e-3F;                     // by which the norm of a quaternion may miss 1

template <class T>
T at(const std::uint8_t* bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes + place, sizeof value);
  return value;
}

double shareAt(const std::uint8_t* bytes, std::size_t place) {
  return std::clamp(at<std::int16_t>(bytes, place) / 32767.0, -1.0, 1.0);
}

bool readRate(const std::uint8_t* bytes, std::size_t size, Command& command) {
  command.rate = size == 2 ? bytes[1] : 0;
  return command.rate >= 1 && command.rate <= kMaxRate;
}

bool readDrive(const std::uint8_t* bytes, std::size_t size, Command& command) {
  if (size < kDriveHead) return false;
  const std::size_t keys = bytes[1];
  if (keys > kMaxKeys || size != kDriveHead + 4 * keys) return false;
  command.grant = at<std::uint32_t>(bytes, 4);
  command.number = at<std::uint32_t>(bytes, 8);
  for (std::size_t k = 0; k < kAxes; ++k) command.axes[k] = shareAt(bytes, 12 + 2 * k);
  for (std::size_t k = 0; k < keys; ++k) {
    const auto key = at<std::uint32_t>(bytes, kDriveHead + 4 * k);
    if (key > kLastKey) return false;
    command.keys.push_back(static_cast<int>(key));
  }
  return true;
}

bool readReplay(const std::uint8_t* bytes, std::size_t size, Command& command) {
  if (size != 24 || bytes[1] > 3) return false;
  command.play = (bytes[1] & 1) != 0;
  command.seek = (bytes[1] & 2) != 0;
  command.speed = at<double>(bytes, 8);
  command.time = at<double>(bytes, 16);
  return command.speed >= kSlowest && command.speed <= kFastest && command.time >= 0 && command.time <= kLongest;
}

bool isPose(const ViewerState::Pose& pose) {
  const bool near = std::all_of(pose.begin(), pose.begin() + 3, [](float x) { return std::abs(x) <= kFarthest; });
  const float norm = std::hypot(std::hypot(pose[3], pose[4]), std::hypot(pose[5], pose[6]));
  return near && std::abs(norm - 1) <= kUnit;  // neither is true of what is not a number
}

bool readViewer(const std::uint8_t* bytes, std::size_t size, ViewerState& viewer) {
  constexpr std::size_t pose_size = sizeof(ViewerState::Pose);
  const auto buttons = size < kViewerHead ? 0U : at<std::uint16_t>(bytes, 2);
  if (size != kViewerHead + kViewerBodies * pose_size || bytes[1] >> kViewerBodies || buttons >> kViewerButtons)
    return false;
  for (std::size_t k = 0; k < kViewerBodies; ++k) {
    if ((bytes[1] >> k & 1) == 0) continue;
    viewer.poses[k] = at<ViewerState::Pose>(bytes, kViewerHead + k * pose_size);
    if (!isPose(*viewer.poses[k])) return false;
  }
  for (std::size_t k = 0; k < kViewerButtons; ++k) viewer.buttons[k] = (buttons >> k & 1) != 0;
  for (std::size_t k = 0; k < viewer.sticks.size(); ++k) viewer.sticks[k] = shareAt(bytes, 4 + 2 * k);
  return true;
}

/// The rest of a command whose kind is known; whether it is one.
bool read(const std::uint8_t* bytes, std::size_t size, Command& command) {
  switch (command.kind) {
    case Command::Kind::Rate:
      return readRate(bytes, size, command);
    case Command::Kind::Take:
    case Command::Kind::GiveBack:
      return size == 1;
    case Command::Kind::Drive:
      return readDrive(bytes, size, command);
    case Command::Kind::Replay:
      return readReplay(bytes, size, command);
    case Command::Kind::Ping:
      if (size == 16) std::copy_n(bytes + 8, 8, command.ping.begin());
      return size == 16;
    case Command::Kind::Drawn:
      if (size == 2) command.drawn = bytes[1];
      return size == 2;
    case Command::Kind::Viewer:
      return readViewer(bytes, size, command.viewer);
  }
  return false;
}

}  // namespace

std::optional<Command> decodeCommand(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return std::nullopt;
  Command command;
  command.kind = static_cast<Command::Kind>(bytes[0]);
  return read(bytes, size, command) ? std::optional(std::move(command)) : std::nullopt;
}

}  // namespace vibe::web
