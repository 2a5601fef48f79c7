#include "vibe_example_input_device/device_stream.hpp"

namespace vibe_example {
namespace {

constexpr std::size_t kFrameSize = 12;
constexpr std::uint8_t kFrameStart = 0xA5;
constexpr double kLengthUnit = 1e-4;  // [m]
constexpr double kAngleUnit = 1e-4;   // [rad]

std::uint16_t uint16At(const std::uint8_t* bytes) {
  return static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
}

bool isFrame(const std::uint8_t* bytes) {
  return bytes[0] == kFrameStart && crc8(bytes, kFrameSize - 1) == bytes[kFrameSize - 1];
}

DeviceSample sampleOf(const std::uint8_t* frame, std::int64_t number) {
  DeviceSample sample;
  sample.number = number;
  sample.joints[0] = kLengthUnit * uint16At(frame + 2);
  for (std::size_t k = 1; k < 4; ++k)
    sample.joints[k] = kAngleUnit * static_cast<std::int16_t>(uint16At(frame + 2 + 2 * k));
  for (std::size_t k = 0; k < sample.buttons.size(); ++k) sample.buttons[k] = frame[10] >> k & 1;
  return sample;
}

}  // namespace

std::vector<DeviceSample> DeviceStream::read(const std::uint8_t* bytes, std::size_t count) {
  pending_.insert(pending_.end(), bytes, bytes + count);
  std::vector<DeviceSample> samples;
  std::size_t place = 0;
  while (pending_.size() - place >= kFrameSize) {
    const std::uint8_t* frame = pending_.data() + place;
    if (!isFrame(frame)) {
      ++place, ++skipped_bytes_;
      continue;
    }
    if (isNew(frame[1])) samples.push_back(sampleOf(frame, last_number_));
    place += kFrameSize;
  }
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(place));
  return samples;
}

// The sequence number wraps, so it is compared by difference: up to 127 ahead is new, otherwise the frame is late.
bool DeviceStream::isNew(std::uint8_t sequence) {
  const auto ahead = static_cast<std::int8_t>(sequence - last_sequence_);
  if (started_ && ahead <= 0) {
    ++dropped_frames_;
    return false;
  }
  if (started_) {
    last_number_ += ahead;
    lost_frames_ += static_cast<std::size_t>(ahead - 1);
  }
  started_ = true;
  last_sequence_ = sequence;
  return true;
}

std::uint8_t crc8(const std::uint8_t* bytes, std::size_t count) {
  unsigned crc = 0;
  for (std::size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80U ? crc << 1 ^ 0x07U : crc << 1) & 0xFFU;
  }
  return static_cast<std::uint8_t>(crc);
}

}  // namespace vibe_example
