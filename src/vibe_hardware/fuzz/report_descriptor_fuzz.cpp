// sources: src/hid/report_descriptor.cpp
#include "vibe_hardware/hid/report_descriptor.hpp"

#include <cstdlib>

#include "vibe_core/common/error.hpp"

// Any bytes as a HID report descriptor: an Error with its sentence, or a layout whose reports fit the kernel's buffers.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void parse(const std::uint8_t* data, std::size_t size) {
  try {
    const vibe::ReportLayout layout = vibe::parseReportDescriptor(data, size);
    require(layout.reports.size() <= 3 * 256);
    for (const vibe::ReportSize& report : layout.reports) {
      require(report.bytes <= 4097 && layout.sizeOf(report.kind, report.id) == report.bytes);
    }
  } catch (const vibe::Error& error) {
    require(*error.what() != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  parse(data, size);
  for (const vibe::DeviceKind kind : {vibe::DeviceKind::Haptic, vibe::DeviceKind::Input}) {
    try {
      vibe::checkReportDescriptor(data, size, kind);
      require(vibe::parseReportDescriptor(data, size).usage == 5);
    } catch (const vibe::Error&) {
    }
  }
  return 0;
}
