#pragma once
#include <cstddef>
#include <cstdint>

namespace vibe_firmware {

enum class ReportType : std::uint8_t { Input = 1, Output = 2, Feature = 3 };

/// A sequence of constant bytes that somebody else owns.
struct Bytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// A HID device as its USB stack, an emulator or a test sees it: descriptors, and reports that are got and set. Never
/// called from the control interrupt; an implementation that shares state with it must protect that itself.
class HidFunction {
 public:
  virtual Bytes deviceDescriptor() const = 0;
  virtual Bytes configurationDescriptor() const = 0;  ///< with interface, HID and endpoint descriptors
  virtual Bytes reportDescriptor() const = 0;
  virtual Bytes string(std::uint8_t index) const = 0;  ///< ASCII; 1 manufacturer, 2 product, 3 serial; empty: none

  /// Writes a report, its id included. @return its size; 0: there is no such report (USB stall)
  virtual std::size_t getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) = 0;

  /// Takes a report, its id included. @return false: there is no such report, or it is malformed (USB stall). A
  /// well-formed set of parameters that is refused for its values is taken (true): StatusReport says why.
  virtual bool setReport(ReportType type, std::uint8_t id, const std::uint8_t* bytes, std::size_t size) = 0;

 protected:
  ~HidFunction() = default;
};

}  // namespace vibe_firmware
