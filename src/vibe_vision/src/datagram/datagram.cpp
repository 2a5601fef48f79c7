#include "vibe_vision/datagram/datagram.hpp"

#include "datagram/byte_reader.hpp"
#include "datagram/byte_writer.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe::vision {
namespace {

constexpr std::uint32_t kMagic = 0x54424956;  // the bytes "VIBT"

void write(const CoordinateSample& sample, ByteWriter& writer) {
  writer.putDouble(sample.position);
  writer.putDouble(sample.velocity);
  writer.putDouble(sample.acceleration);
  writer.putDouble(sample.jerk);
  for (const float value : sample.covariance) writer.putFloat(value);
}

void write(const InstrumentSample& sample, ByteWriter& writer) {
  writer.putUnsigned<std::uint8_t>(sample.tracked);
  writer.putUnsigned(sample.reason);
  writer.putUnsigned<std::uint8_t>(sample.has_rotation);
  writer.putUnsigned<std::uint8_t>(0);
  writer.putFloat(sample.score);
  write(sample.slide, writer);
  write(sample.rotation, writer);
}

CoordinateSample readCoordinate(ByteReader& reader) {
  CoordinateSample sample;
  sample.position = reader.getDouble();
  sample.velocity = reader.getDouble();
  sample.acceleration = reader.getDouble();
  sample.jerk = reader.getDouble();
  for (float& value : sample.covariance) value = reader.getFloat();
  return sample;
}

/// @param valid  becomes false if padding is not 0
InstrumentSample readInstrument(ByteReader& reader, bool& valid) {
  InstrumentSample sample;
  sample.tracked = reader.getFlag();
  sample.reason = reader.getUnsigned<std::uint8_t>();
  sample.has_rotation = reader.getFlag();
  valid = reader.getUnsigned<std::uint8_t>() == 0 && valid;
  sample.score = reader.getFloat();
  sample.slide = readCoordinate(reader);
  sample.rotation = readCoordinate(reader);
  return sample;
}

}  // namespace

std::vector<std::uint8_t> encode(const TrackDatagram& datagram) {
  if (datagram.instruments.size() > kMaxInstruments) {
    throw Error("A datagram cannot hold " + std::to_string(datagram.instruments.size()) +
                " instruments; configure at most " + std::to_string(kMaxInstruments) + ".");
  }
  ByteWriter writer;
  writer.putUnsigned(kMagic);
  writer.putUnsigned(kDatagramVersion);
  writer.putUnsigned(static_cast<std::uint8_t>(datagram.instruments.size()));
  writer.putUnsigned<std::uint8_t>(0);
  writer.putUnsigned(datagram.sequence);
  writer.putFloat(datagram.exposure);
  writer.putUnsigned(datagram.frame_sequence);
  writer.putDouble(datagram.stamp);
  writer.putFloat(datagram.age);
  writer.putFloat(datagram.jerk_time);
  for (const InstrumentSample& sample : datagram.instruments) write(sample, writer);
  return writer.take();
}

std::optional<TrackDatagram> decode(const std::uint8_t* bytes, std::size_t size) {
  ByteReader reader(bytes, size);
  bool valid = reader.getUnsigned<std::uint32_t>() == kMagic;
  valid = reader.getUnsigned<std::uint16_t>() == kDatagramVersion && valid;
  const std::size_t count = reader.getUnsigned<std::uint8_t>();
  valid = count <= kMaxInstruments && size == kDatagramHeader + count * kDatagramInstrument && valid;
  valid = reader.getUnsigned<std::uint8_t>() == 0 && valid;
  if (!valid || !reader.ok()) return std::nullopt;
  TrackDatagram datagram;
  datagram.sequence = reader.getUnsigned<std::uint32_t>();
  datagram.exposure = reader.getFloat();
  datagram.frame_sequence = reader.getUnsigned<std::uint64_t>();
  datagram.stamp = reader.getDouble();
  datagram.age = reader.getFloat();
  datagram.jerk_time = reader.getFloat();
  for (std::size_t i = 0; i < count; ++i) datagram.instruments.push_back(readInstrument(reader, valid));
  if (!valid || !reader.ok() || !reader.atEnd()) return std::nullopt;
  return datagram;
}

}  // namespace vibe::vision
