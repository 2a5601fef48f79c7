#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibe_example {

// [recipe]
/// One sample of the device: the four axes of the scope and six buttons.
struct DeviceSample {
  std::int64_t number = 0;         ///< of the sample since the first one; lost samples are counted too
  std::array<double, 4> joints{};  ///< insertion [m], rotation, tip up/down, tip left/right [rad]
  std::array<bool, 6> buttons{};   ///< in the order of scope/buttons; true while pressed
};
// [/recipe]

/// Finds the samples in the bytes of the device, which takes 100 samples per second. A frame has 12 bytes; numbers of
/// two bytes are little-endian:
///
/// | byte | type | content |
/// |---|---|---|
/// | 0 | uint8 | 0xA5 |
/// | 1 | uint8 | sequence number, 0 after 255 |
/// | 2 | uint16 | insertion [0.1 mm] |
/// | 4, 6, 8 | int16 | rotation, tip up/down, tip left/right [0.0001 rad] |
/// | 10 | uint8 | buttons, bits 0 to 5 |
/// | 11 | uint8 | CRC-8 of bytes 0 to 10 (polynomial 0x07, initial value 0) |
class DeviceStream {
 public:
  static constexpr double kPeriod = 0.01;  ///< between two samples [s]

  /// Takes the next bytes, any number of them. Bytes that are not part of a correct frame are skipped, and frames that
  /// are not newer than the last one are dropped.
  /// @return the samples that are complete now, in order
  std::vector<DeviceSample> read(const std::uint8_t* bytes, std::size_t count);

  std::size_t skippedBytes() const { return skipped_bytes_; }
  std::size_t droppedFrames() const { return dropped_frames_; }  ///< repeated or out of order
  std::size_t lostFrames() const { return lost_frames_; }        ///< missing in the sequence, for any reason

 private:
  bool isNew(std::uint8_t sequence);

  std::vector<std::uint8_t> pending_;  // an incomplete frame
  bool started_ = false;
  std::uint8_t last_sequence_ = 0;
  std::int64_t last_number_ = 0;
  std::size_t skipped_bytes_ = 0, dropped_frames_ = 0, lost_frames_ = 0;
};

/// CRC-8 with polynomial 0x07 and initial value 0 (CRC-8/SMBUS); it is 0xF4 for the digits "123456789".
std::uint8_t crc8(const std::uint8_t* bytes, std::size_t count);

}  // namespace vibe_example
