#pragma GCC diagnostic ignored "-Wconversion"
#include "vibe_firmware/protocol/control_endpoint.hpp"
#include <algorithm>
#include <cstring>
namespace vibe_firmware {
int ControlEndpoint::handle(const UsbSetup& s, const std::uint8_t* data, std::uint8_t* r, std::size_t cap) {
  auto give = [&](Bytes b) { int n = (int)std::min({b.size, cap, (std::size_t)s.length}); std::memcpy(r, b.data, n); return n; };
  switch (s.request_type << 8 | s.request) {
    case 0x8006: switch (s.value >> 8) { case 1: return give(function_.deviceDescriptor()); case 2: return give(function_.configurationDescriptor());
      case 3: { std::uint8_t t[64]; if ((s.value & 255) == 0) { std::uint8_t l[4] = {4, 3, 9, 4}; return give({l, 4}); } Bytes x = function_.string(s.value & 255); if (!x.data) return -1; t[0] = 2 + 2 * x.size; t[1] = 3; for (std::size_t k = 0; k < x.size; k++) { t[2 + 2 * k] = x.data[k]; t[3 + 2 * k] = 0; } return give({t, t[0]}); } } return -1;
    case 0x8106: if (s.value >> 8 == 0x22) return give(function_.reportDescriptor()); return -1;
    case 0x8000: r[0] = r[1] = 0; return 2;
    case 0x0009: configuration_ = s.value; return 0;
    case 0x210a: idle_rate_ = s.value >> 8; return 0;
    case 0x0102: case 0x0201: case 0x010b: return 0;
    case 0xa101: { std::uint8_t b[64]; auto n = function_.getReport((ReportType)(s.value >> 8), s.value & 255, b, 64); return n ? give({b, n}) : -1; }
    case 0x2109: return function_.setReport((ReportType)(s.value >> 8), s.value & 255, data, s.length) ? 0 : -1;
  }
  return -1;
}
}
