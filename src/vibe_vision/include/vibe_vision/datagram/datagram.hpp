#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vibe {

/// One instrument in a datagram.
struct InstrumentSample {
  std::uint8_t tracked = 0;  ///< 1: all numbers below are valid
  std::uint8_t reason = 0;   ///< LostReason
  std::uint8_t has_rotation = 0;
  double position = 0, velocity = 0, acceleration = 0;  ///< of the joint at `stamp` [m], [m/s], [m/s^2]
  double rotation = 0, angular_velocity = 0;            ///< [rad], [rad/s]
  float position_variance = 0, cross_covariance = 0, rotation_variance = 0;  ///< [m^2], [m rad], [rad^2]
  float score = 0;
};

/// One frame's result for programs that are not ROS nodes. docs/vision.md, "Datagram".
struct TrackDatagram {
  std::uint32_t sequence = 0;                 ///< of the datagram
  std::uint64_t frame_sequence = 0;           ///< of the camera
  double stamp = 0;                           ///< middle of the exposure, Unix time [s]
  float exposure = 0;                         ///< [s]
  float age = 0;                              ///< from stamp to sending [s]
  std::vector<InstrumentSample> instruments;  ///< at most kMaxInstruments
};

constexpr std::uint16_t kDatagramVersion = 1;
constexpr std::size_t kMaxInstruments = 8;

/// Little-endian, fixed layout for a number of instruments. @throws Error for too many
std::vector<std::uint8_t> encode(const TrackDatagram& datagram);
/// @return nothing for bytes that are not a datagram of this version
std::optional<TrackDatagram> decode(const std::uint8_t* bytes, std::size_t size);

}  // namespace vibe
