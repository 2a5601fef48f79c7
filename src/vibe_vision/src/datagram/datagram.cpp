#include "vibe_vision/datagram/datagram.hpp"

#include <boost/endian/conversion.hpp>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include <netdb.h>
#include <unistd.h>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {

namespace {

constexpr std::uint32_t kMagic = 0x54424956;  // the bytes "VIBT"

namespace endian = boost::endian;

/// Takes little-endian numbers from bytes, on any machine. After the end or a number that may not be there, they stay.
class Reader {
 public:
  Reader(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), left_(size) {}

  template <class T>
  void operator()(T& value) {
    valid_ = valid_ && left_ >= sizeof(T);
    if (!valid_) return;
    value = endian::endian_load<T, sizeof(T), endian::order::little>(bytes_);
    bytes_ += sizeof(T);
    left_ -= sizeof(T);
  }
  void operator()(bool& value) {
    std::uint8_t byte = 0;
    (*this)(byte);
    valid_ = valid_ && byte <= 1;
    value = byte == 1;
  }
  template <class T>
  void constant(T expected) {
    T value{};
    (*this)(value);
    valid_ = valid_ && value == expected;
  }
  bool isWhole() const { return valid_ && left_ == 0; }

 private:
  const std::uint8_t* bytes_;
  std::size_t left_;
  bool valid_ = true;
};

/// Appends little-endian numbers.
struct Writer {
  template <class T>
  void operator()(const T& value) {
    bytes.resize(bytes.size() + sizeof(T));
    endian::endian_store<T, sizeof(T), endian::order::little>(&bytes.back() + 1 - sizeof(T), value);
  }
  void operator()(const bool& value) { (*this)(static_cast<std::uint8_t>(value)); }
  template <class T>
  void constant(T value) {
    (*this)(value);
  }
  std::vector<std::uint8_t> bytes;
};

// The layout, for both ways.

template <class Way, class Datagram>
void passHeader(Way& way, Datagram& datagram, std::uint8_t& count) {
  way.constant(kMagic);
  way.constant(kDatagramVersion);
  way(count);
  way.constant(std::uint8_t{0});
  way(datagram.sequence);
  way(datagram.exposure);
  way(datagram.frame_sequence);
  way(datagram.stamp);
  way(datagram.age);
  way(datagram.jerk_time);
}

template <class Way, class Coordinate>
void passCoordinate(Way& way, Coordinate& sample) {
  way(sample.position);
  way(sample.velocity);
  way(sample.acceleration);
  way(sample.jerk);
  for (auto& value : sample.covariance) way(value);
}

template <class Way, class Instrument>
void passInstrument(Way& way, Instrument& sample) {
  way(sample.tracked);
  way(sample.reason);
  way(sample.has_rotation);
  way.constant(std::uint8_t{0});
  way(sample.score);
  passCoordinate(way, sample.slide);
  passCoordinate(way, sample.rotation);
}

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

std::vector<std::uint8_t> encode(const TrackDatagram& datagram) {
  if (datagram.instruments.size() > kMaxInstruments) {
    throw Error("A datagram cannot hold " + std::to_string(datagram.instruments.size()) +
                " instruments; configure at most " + std::to_string(kMaxInstruments) + ".");
  }
  Writer writer;
  auto count = static_cast<std::uint8_t>(datagram.instruments.size());
  passHeader(writer, datagram, count);
  for (const InstrumentSample& sample : datagram.instruments) passInstrument(writer, sample);
  return writer.bytes;
}

std::optional<TrackDatagram> decode(const std::uint8_t* bytes, std::size_t size) {
  Reader reader(bytes, size);
  TrackDatagram datagram;
  std::uint8_t count = 0;
  passHeader(reader, datagram, count);
  if (count > kMaxInstruments || size != kDatagramHeader + count * kDatagramInstrument) return std::nullopt;
  datagram.instruments.resize(count);
  for (InstrumentSample& sample : datagram.instruments) passInstrument(reader, sample);
  if (!reader.isWhole()) return std::nullopt;
  return datagram;
}

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
