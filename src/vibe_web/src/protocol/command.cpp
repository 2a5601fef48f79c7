#include "protocol/command.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

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

std::optional<Command> readRate(const std::uint8_t* bytes, std::size_t size) {
  Command command;
  command.kind = Command::Kind::Rate;
  command.rate = size == 2 ? bytes[1] : 0;
  if (command.rate < 1 || command.rate > kMaxRate) return std::nullopt;
  return command;
}

std::optional<Command> readDrawn(const std::uint8_t* bytes, std::size_t size) {
  Command command;
  command.kind = Command::Kind::Drawn;
  if (size != 2) return std::nullopt;
  command.drawn = bytes[1];
  return command;
}

std::optional<Command> readWord(Command::Kind kind, std::size_t size) {
  Command command;
  command.kind = kind;
  if (size != 1) return std::nullopt;
  return command;
}

std::optional<Command> readDrive(const std::uint8_t* bytes, std::size_t size) {
  if (size < kDriveHead) return std::nullopt;
  const std::size_t keys = bytes[1];
  if (keys > kMaxKeys || size != kDriveHead + 4 * keys) return std::nullopt;
  Command command;
  command.kind = Command::Kind::Drive;
  command.grant = at<std::uint32_t>(bytes, 4);
  command.number = at<std::uint32_t>(bytes, 8);
  for (std::size_t k = 0; k < kAxes; ++k) command.axes[k] = shareAt(bytes, 12 + 2 * k);
  for (std::size_t k = 0; k < keys; ++k) {
    const auto key = at<std::uint32_t>(bytes, kDriveHead + 4 * k);
    if (key > kLastKey) return std::nullopt;
    command.keys.push_back(static_cast<int>(key));
  }
  return command;
}

std::optional<Command> readReplay(const std::uint8_t* bytes, std::size_t size) {
  if (size != 16 || bytes[1] > 3) return std::nullopt;
  Command command;
  command.kind = Command::Kind::Replay;
  command.play = (bytes[1] & 1) != 0;
  command.seek = (bytes[1] & 2) != 0;
  command.speed = static_cast<double>(at<float>(bytes, 4));
  command.time = at<double>(bytes, 8);
  if (!(command.speed >= kSlowest - 1e-6 && command.speed <= kFastest)) return std::nullopt;
  if (!(command.time >= 0 && command.time <= kLongest)) return std::nullopt;
  return command;
}

bool isPose(const ViewerState::Pose& pose) {
  const bool near = std::all_of(pose.begin(), pose.begin() + 3, [](float x) { return std::abs(x) <= kFarthest; });
  const float norm = std::hypot(std::hypot(pose[3], pose[4]), std::hypot(pose[5], pose[6]));
  return near && std::abs(norm - 1) <= kUnit;  // neither is true of what is not a number
}

std::optional<Command> readViewer(const std::uint8_t* bytes, std::size_t size) {
  constexpr std::size_t pose_size = sizeof(ViewerState::Pose);
  const auto buttons = size < kViewerHead ? 0U : at<std::uint16_t>(bytes, 2);
  if (size != kViewerHead + kViewerBodies * pose_size || bytes[1] >> kViewerBodies || buttons >> kViewerButtons)
    return std::nullopt;
  Command command;
  command.kind = Command::Kind::Viewer;
  ViewerState& viewer = command.viewer;
  for (std::size_t k = 0; k < kViewerBodies; ++k) {
    if ((bytes[1] >> k & 1) == 0) continue;
    viewer.poses[k] = at<ViewerState::Pose>(bytes, kViewerHead + k * pose_size);
    if (!isPose(*viewer.poses[k])) return std::nullopt;
  }
  for (std::size_t k = 0; k < kViewerButtons; ++k) viewer.buttons[k] = (buttons >> k & 1) != 0;
  for (std::size_t k = 0; k < viewer.sticks.size(); ++k) viewer.sticks[k] = shareAt(bytes, 4 + 2 * k);
  return command;
}

std::optional<Command> readPing(const std::uint8_t* bytes, std::size_t size) {
  if (size != 16) return std::nullopt;
  Command command;
  std::copy_n(bytes + 8, 8, command.ping.begin());
  return command;
}

}  // namespace

std::optional<Command> decodeCommand(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return std::nullopt;
  switch (static_cast<Command::Kind>(bytes[0])) {
    case Command::Kind::Rate:
      return readRate(bytes, size);
    case Command::Kind::Take:
    case Command::Kind::GiveBack:
      return readWord(static_cast<Command::Kind>(bytes[0]), size);
    case Command::Kind::Drive:
      return readDrive(bytes, size);
    case Command::Kind::Replay:
      return readReplay(bytes, size);
    case Command::Kind::Ping:
      return readPing(bytes, size);
    case Command::Kind::Drawn:
      return readDrawn(bytes, size);
    case Command::Kind::Viewer:
      return readViewer(bytes, size);
  }
  return std::nullopt;
}

}  // namespace vibe::web
