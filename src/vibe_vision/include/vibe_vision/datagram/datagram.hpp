#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sys/socket.h>

namespace vibe::vision {

/// One coordinate of an instrument as the predictor knows it at the stamp of its datagram [m] or [rad], and seconds.
struct CoordinateSample {
  double position = 0, velocity = 0, acceleration = 0, jerk = 0;  ///< [m, m/s, m/s^2, m/s^3] or the same of [rad]
  /// Upper triangle of their covariance, row by row: pp, pv, pa, pj, vv, va, vj, aa, aj, jj.
  std::array<float, 10> covariance{};
};

/// One instrument in a datagram.
struct InstrumentSample {
  bool tracked = false;              ///< if not, all numbers below are NaN, score is 0 and `reason` says why
  std::uint8_t reason = 0;           ///< LostReason
  bool has_rotation = false;         ///< if not, `rotation` is NaN
  float score = 0;                   ///< how well the picture fits the marker, 0 to 1
  CoordinateSample slide, rotation;  ///< of the joints
};

/// One frame's result for programs that are not ROS nodes. docs/vision.md, "Datagram".
struct TrackDatagram {
  std::uint32_t sequence = 0;                 ///< of the datagram
  float exposure = 0;                         ///< [s]; 0: unknown
  std::uint64_t frame_sequence = 0;           ///< of the camera
  double stamp = 0;                           ///< middle of the exposure, Unix time [s]
  float age = 0;                              ///< from stamp to sending [s]
  float jerk_time = 0;                        ///< correlation time of the jerk, for extrapolation [s]
  std::vector<InstrumentSample> instruments;  ///< in the order of the configuration, at most kMaxInstruments
};

constexpr std::uint16_t kDatagramVersion = 1;     ///< in each datagram; decode() takes no other
constexpr std::size_t kMaxInstruments = 8;        ///< in one datagram
constexpr std::size_t kDatagramHeader = 40;       ///< [bytes]
constexpr std::size_t kDatagramInstrument = 152;  ///< [bytes]

/// Little-endian, fixed layout for a number of instruments. @throws Error for more than kMaxInstruments
std::vector<std::uint8_t> encode(const TrackDatagram& datagram);
/// @return nothing for bytes that are not a datagram of this version: another magic, version or length, more than
///         kMaxInstruments, a flag that is neither 0 nor 1, padding that is not 0
std::optional<TrackDatagram> decode(const std::uint8_t* bytes, std::size_t size);

/// Sends datagrams to one address; never waits and never receives. A receiver that is not there is no error.
class UdpSender {
 public:
  /// @param target  "host:port", or "[address]:port" for IPv6. @throws Error if it cannot be understood or resolved
  explicit UdpSender(const std::string& target);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// Sends one datagram at once, or counts it as failed.
  void send(const std::vector<std::uint8_t>& bytes);
  std::uint64_t sent() const { return sent_; }      ///< datagrams that the system took
  std::uint64_t failed() const { return failed_; }  ///< datagrams that the system did not take

 private:
  int socket_ = -1;
  sockaddr_storage address_{};
  socklen_t address_size_ = 0;
  std::atomic<std::uint64_t> sent_{0}, failed_{0};
};

}  // namespace vibe::vision
