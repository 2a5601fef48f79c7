// sources: src/hid/report_descriptor.cpp
#include "vibe_hardware/hid/report_descriptor.hpp"

#include <cstdlib>

#include "vibe_core/program/error.hpp"

namespace hardware = vibe::hardware;

// Any bytes as a HID report descriptor: an Error with its sentence, or a layout whose reports fit the kernel's buffers.

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void parse(const std::uint8_t* data, std::size_t size) {
  try {
    const hardware::ReportLayout layout = hardware::parseReportDescriptor(data, size);
    require(layout.reports.size() <= 3 * 256);
    for (const hardware::ReportSize& report : layout.reports) {
      require(report.bytes <= 4097 && layout.sizeOf(report.kind, report.id) == report.bytes);
    }
  } catch (const vibe::Error& error) {
    require(*error.what() != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  parse(data, size);
  for (const hardware::DeviceKind kind : {hardware::DeviceKind::Haptic, hardware::DeviceKind::Input}) {
    try {
      hardware::checkReportDescriptor(data, size, kind);
      require(hardware::parseReportDescriptor(data, size).usage == 5);
    } catch (const vibe::Error&) {
    }
  }
  return 0;
}
