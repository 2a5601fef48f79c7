#pragma once

#include <cstddef>
#include <cstdint>

namespace vibe_firmware {

/// Kind of a report, as the high byte of wValue of GET_REPORT and SET_REPORT has it (HID 1.11, 7.2.1).
enum class ReportType : std::uint8_t { Input = 1, Output = 2, Feature = 3 };

/// A sequence of constant bytes that somebody else owns.
struct Bytes {
  const std::uint8_t* data = nullptr;  ///< null only if there are none
  std::size_t size = 0;                ///< how many
};
/// Of a constant that lasts. @tparam Array  std::array of bytes
template <typename Array>
constexpr Bytes bytesOf(const Array& bytes) {
  return {bytes.data(), bytes.size()};
}

/// A HID device as its USB stack, an emulator or a test sees it: descriptors, and reports that are got and set. Never
/// called from the control interrupt; an implementation that shares state with it must protect that itself.
class HidFunction {
 public:
  virtual Bytes deviceDescriptor() const = 0;          ///< USB 2.0, table 9-8
  virtual Bytes configurationDescriptor() const = 0;   ///< with interface, HID and endpoint descriptors
  virtual Bytes reportDescriptor() const = 0;          ///< HID 1.11, 6.2.2
  virtual Bytes string(std::uint8_t index) const = 0;  ///< ASCII; 1 manufacturer, 2 product, 3 serial; empty: none

  /// Writes a report, its id included. @return its size; 0: there is no such report (USB stall)
  virtual std::size_t getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) = 0;

  /// Takes a report, its id included. @return false: there is no such report, or it is malformed (USB stall). A
  /// well-formed set of parameters that is refused for its values is taken (true): StatusReport says why.
  virtual bool setReport(ReportType type, std::uint8_t id, const std::uint8_t* bytes, std::size_t size) = 0;

 protected:
  ~HidFunction() = default;
};

/// Setup stage of a USB control transfer (USB 2.0, table 9-2).
struct UsbSetup {
  std::uint8_t request_type = 0;  ///< bmRequestType: direction, kind and recipient
  std::uint8_t request = 0;       ///< bRequest
  std::uint16_t value = 0;        ///< wValue: depends on the request
  std::uint16_t index = 0;        ///< wIndex: interface or endpoint, or the language of a string
  std::uint16_t length = 0;       ///< wLength: bytes of the data stage at most
};

/// Answers control requests of the host: standard requests (USB 2.0, chapter 9) and those of the HID class (HID 1.11,
/// chapter 7). Independent of any controller: a port feeds it with the setup packets of its hardware, an emulator with
/// those of a socket. The port itself stores the address of SET_ADDRESS, which is only acknowledged here, and calls
/// reset() after a bus reset.
class ControlEndpoint {
 public:
  static constexpr int kStall = -1;  ///< result of handle(): the request is not understood

  /// The host has configured nothing yet. @param function  has to outlive it
  explicit ControlEndpoint(HidFunction& function) : function_(function) {}

  /// @param data      of the data stage from the host, setup.length bytes; unused for requests to the host
  /// @param response  of the data stage to the host
  /// @return bytes of the response, never more than setup.length or capacity; kStall: the request is not understood
  int handle(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response, std::size_t capacity);

  /// Back to the state after power-up.
  void reset();

  /// Input reports may be sent.
  bool configured() const { return configuration_ != 0; }

  /// The host has halted the interrupt endpoint: it must answer STALL.
  bool halted() const { return halted_; }

 private:
  int standardDevice(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity);
  int standardInterface(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity);
  int standardEndpoint(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity);
  int classInterface(const UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response, std::size_t capacity);
  int descriptor(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) const;
  int string(const UsbSetup& setup, std::uint8_t* response, std::size_t capacity) const;

  HidFunction& function_;
  std::uint8_t configuration_ = 0;
  std::uint8_t idle_rate_ = 0;  // unit 4 ms; 0: no repetition. Kept for the host only: reports come every 10 ms anyway
  bool halted_ = false;
};

}  // namespace vibe_firmware
