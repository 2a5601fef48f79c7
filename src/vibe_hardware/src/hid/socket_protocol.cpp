#include "vibe_hardware/hid/socket_protocol.hpp"

namespace vibe::hardware {
namespace {

void appendU16(std::size_t value, Packet& packet) {
  packet.push_back(static_cast<std::uint8_t>(value & 0xFF));
  packet.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFF));
}

template <typename Bytes>
void appendBytes(const Bytes& bytes, Packet& packet) {
  appendU16(bytes.size(), packet);
  packet.insert(packet.end(), bytes.begin(), bytes.end());
}

/// Reads fields one after the other; after the first that is cut off, all fail.
class FieldReader {
 public:
  FieldReader(const std::uint8_t* bytes, std::size_t size) : next_(bytes), left_(size) {}

  std::size_t number(std::size_t size) {
    std::size_t value = 0;
    if (!take(size)) return 0;
    for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::size_t>(next_[i - size]) << 8 * i;
    return value;
  }

  template <typename Bytes>
  Bytes bytes() {
    const std::size_t size = number(2);
    if (!take(size)) return {};
    return Bytes(next_ - size, next_);
  }

  bool complete() const { return good_ && left_ == 0; }

 private:
  bool take(std::size_t size) {
    good_ = good_ && size <= left_;
    if (!good_) return false;
    next_ += size;
    left_ -= size;
    return true;
  }

  const std::uint8_t* next_;
  std::size_t left_;
  bool good_ = true;
};

}  // namespace

Packet packHello(const Hello& hello) {
  Packet packet{kHello, kSocketVersion};
  appendU16(hello.vendor, packet);
  appendU16(hello.product, packet);
  appendBytes(hello.serial, packet);
  appendBytes(hello.name, packet);
  appendBytes(hello.report_descriptor, packet);
  return packet;
}

std::optional<Hello> unpackHello(const std::uint8_t* bytes, std::size_t size) {
  FieldReader reader(bytes, size);
  if (reader.number(1) != kHello || reader.number(1) != kSocketVersion) return {};
  Hello hello;
  hello.vendor = static_cast<std::uint16_t>(reader.number(2));
  hello.product = static_cast<std::uint16_t>(reader.number(2));
  hello.serial = reader.bytes<std::string>();
  hello.name = reader.bytes<std::string>();
  hello.report_descriptor = reader.bytes<std::vector<std::uint8_t>>();
  if (!reader.complete()) return {};
  return hello;
}

}  // namespace vibe::hardware
