// sources: src/datagram/datagram.cpp
#include <cstdlib>
#include <vector>

#include "vibe_vision/datagram/datagram.hpp"

// Any bytes as a datagram: nothing, or one that is encoded to the same bytes again.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::uint8_t> bytes(data, data + size);  // so that the sanitizer sees its end
  const auto datagram = vibe::decode(bytes.data(), bytes.size());
  if (!datagram) return 0;
  require(datagram->instruments.size() <= vibe::kMaxInstruments);
  const std::vector<std::uint8_t> again = vibe::encode(*datagram);
  const auto twice = vibe::decode(again.data(), again.size());
  require(twice && vibe::encode(*twice) == again);
  return 0;
}
