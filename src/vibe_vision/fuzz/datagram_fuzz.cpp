// sources: src/datagram/datagram.cpp
#include <cstdlib>
#include <vector>

#include "vibe_vision/datagram/datagram.hpp"

namespace vision = vibe::vision;

// Any bytes as a datagram, and valid ones with some bytes changed: nothing, or a datagram that is encoded and decoded
// again to the same bytes.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const std::vector<std::uint8_t>& bytes) {
  const auto datagram = vision::decode(bytes.data(), bytes.size());
  if (!datagram) return;
  require(datagram->instruments.size() <= vision::kMaxInstruments);
  const std::vector<std::uint8_t> again = vision::encode(*datagram);
  const auto twice = vision::decode(again.data(), again.size());
  require(twice && vision::encode(*twice) == again);
}

/// A valid datagram in which pairs of bytes say what changes where.
std::vector<std::uint8_t> nearlyRight(const std::uint8_t* data, std::size_t size) {
  vision::TrackDatagram datagram;
  datagram.instruments.resize(data[0] % (vision::kMaxInstruments + 1));
  std::vector<std::uint8_t> bytes = vision::encode(datagram);
  require(vision::decode(bytes.data(), bytes.size()).has_value());
  for (std::size_t i = 2; i + 2 < size; i += 3)
    bytes[(static_cast<std::size_t>(data[i]) << 8 | data[i + 1]) % bytes.size()] = data[i + 2];
  if (data[1] < 128) bytes.resize(bytes.size() * data[1] / 128);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  check(std::vector<std::uint8_t>(data, data + size));  // a copy, so that the sanitizer sees its end
  if (size > 1) check(nearlyRight(data, size));
  return 0;
}
