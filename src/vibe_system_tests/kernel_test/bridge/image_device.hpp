#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "usb_device.hpp"

namespace vibe::hardware {

/// The firmware image that runs in an emulated board: its USB packets come through a socket, the board's serial port.
///
/// | to the image | from the image |
/// |---|---|
/// | 'S', setup packet [8], data stage from the host | 'C', int16 size or -1 (stall), data stage to the host |
/// | 'R': bus reset | |
/// | | 'I', uint8 size, input report |
class ImageDevice : public UsbDevice {
 public:
  /// Connects to the serial port of the board. @throws std::runtime_error: nobody listens there
  explicit ImageDevice(const std::string& socket_path);
  ~ImageDevice() override;
  ImageDevice(const ImageDevice&) = delete;
  ImageDevice& operator=(const ImageDevice&) = delete;

  int control(const vibe_firmware::UsbSetup& setup, const std::uint8_t* data, std::uint8_t* response,
              std::size_t capacity) override;
  void reset() override;
  int descriptor() const override { return connection_; }
  void service(const ReportSink& sink) override;

 private:
  /// A frame from the image without its type and size.
  struct Frame {
    char type = 0;
    int result = 0;  ///< of 'C': size or -1
    std::vector<std::uint8_t> bytes;
  };

  bool takeFrame(Frame& frame);
  bool readMore(int timeout_ms);

  int connection_;
  std::vector<std::uint8_t> received_;              ///< not yet a whole frame
  std::vector<std::vector<std::uint8_t>> reports_;  ///< that came while an answer was awaited
};

}  // namespace vibe::hardware
