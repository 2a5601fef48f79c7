#pragma once
#include <cstddef>
#include <cstdint>

#include "usb_board.hpp"
#include "vibe_firmware/hal/board.hpp"
#include "vibe_firmware/hal/byte_queue.hpp"

namespace vibe_firmware::mps2 {

/// USB over UART 1, for a program on the host that plays the host controller:
///
///   qemu-system-arm -M mps2-an500 -icount shift=6,align=on -display none -monitor none -semihosting-config
///     enable=on,target=native -serial null -chardev socket,id=usb,path=SOCKET -serial chardev:usb -kernel IMAGE
///
/// With -icount, virtual time follows the instructions. Without it, ticks pile up on a busy host before the main loop
/// runs, and reports are lost.
///
/// Frames, little-endian:
///
/// | direction | frame |
/// |---|---|
/// | to the firmware | 'S', setup packet (8 bytes), data stage of a request from the host |
/// | to the firmware | 'R': bus reset |
/// | to the firmware | 'E', 2 x int32 encoder counts, uint16 buttons: see SimulatedEncoders::moveTo() |
/// | to the firmware | 'Q': end the emulation with status 0 |
/// | from the firmware | 'C', int16 result (-1: stall), data stage: answer to 'S' |
/// | from the firmware | 'I', uint8 size, input report |
///
/// Up to 500 reports wait until the host takes them; further ones are dropped. A byte that begins no frame is skipped.
/// A data stage longer than ControlHandler::kMaxData is read and stalled.
class UartLink : public UsbLink {
 public:
  explicit UartLink(SimulatedEncoders& encoders);
  void poll(ControlHandler& handler) override;
  bool sendReport(const std::uint8_t* bytes, std::size_t size) override;

 private:
  static constexpr std::size_t kSetupFrame = 9;
  static constexpr std::size_t kEncoderFrame = 11;

  void transmit();
  void take(std::uint8_t byte, ControlHandler& handler);
  std::size_t frameSize() const;
  void handleFrame(ControlHandler& handler);
  void answer(ControlHandler& handler);
  UsbSetup setup() const;

  SimulatedEncoders& encoders_;
  std::uint8_t frame_[kSetupFrame + ControlHandler::kMaxData];
  ByteQueue<16384> queue_;
  std::size_t received_ = 0;  // of the present frame, bytes beyond frame_ included
};

}  // namespace vibe_firmware::mps2
