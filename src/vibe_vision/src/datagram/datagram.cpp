#include "vibe_vision/datagram/datagram.hpp"

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include <netdb.h>
#include <unistd.h>

#include "datagram/little_endian.hpp"
#include "vibe_core/program/error.hpp"

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

namespace {

constexpr int kLargestPort = 65535;

[[noreturn]] void fail(const std::string& target, const std::string& problem) {
  throw Error("The address '" + target + "' for datagrams " + problem +
              "; write host:port, for example 127.0.0.1:9870.");
}

/// Host and port of "host:port" or "[address]:port".
std::pair<std::string, std::string> split(const std::string& target) {
  const std::size_t colon = target.rfind(':');
  if (colon == std::string::npos || colon == 0) fail(target, "has no host and port");
  std::string host = target.substr(0, colon);
  const std::string port = target.substr(colon + 1);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string::npos) {
    fail(target, "has more than one ':' (put an IPv6 address in brackets)");
  }
  const bool digits = !port.empty() && port.find_first_not_of("0123456789") == std::string::npos && port.size() <= 5;
  if (!digits || std::stoi(port) < 1 || std::stoi(port) > kLargestPort) fail(target, "has no port from 1 to 65535");
  return {host, port};
}

}  // namespace

UdpSender::UdpSender(const std::string& target) {
  const auto [host, port] = split(target);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int status = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  if (status != 0) fail(target, std::string("cannot be resolved (") + gai_strerror(status) + ")");
  // not connected: a receiver that is not there yet must not make later datagrams fail
  socket_ = socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) fail(target, std::string("cannot be used (") + std::strerror(errno) + ")");
  std::memcpy(&address_, found->ai_addr, found->ai_addrlen);
  address_size_ = found->ai_addrlen;
}

UdpSender::~UdpSender() {
  if (socket_ >= 0) close(socket_);
}

void UdpSender::send(const std::vector<std::uint8_t>& bytes) {
  const auto* address = reinterpret_cast<const sockaddr*>(&address_);
  const ssize_t taken = sendto(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL, address, address_size_);
  ++(taken == static_cast<ssize_t>(bytes.size()) ? sent_ : failed_);
}

}  // namespace vibe::vision
