#include "uart_link.hpp"

#include <cstring>

#include "registers.hpp"
#include "semihosting.hpp"

namespace vibe_firmware::mps2 {
namespace {

std::uint32_t integer(const std::uint8_t* bytes, int size) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(bytes[i]) << 8 * i;
  return value;
}

}  // namespace

UartLink::UartLink(SimulatedEncoders& encoders) : encoders_(encoders) {
  uart1().divider = kSmallestDivider;
  uart1().control = kTransmitAndReceive;
}

void UartLink::poll(ControlHandler& handler) {
  while (uart1().state & kReceiverFull) take(static_cast<std::uint8_t>(uart1().data), handler);
  transmit();
}

void UartLink::transmit() {
  while (!queue_.empty() && !(uart1().state & kTransmitterFull)) uart1().data = queue_.take();
}

bool UartLink::sendReport(const std::uint8_t* bytes, std::size_t size) {
  constexpr std::size_t kPacket = 64;  // of a full-speed interrupt endpoint
  if (size > kPacket) return false;
  std::uint8_t frame[2 + kPacket] = {'I', static_cast<std::uint8_t>(size)};
  std::memcpy(frame + 2, bytes, size);
  return queue_.put(frame, 2 + size);
}

void UartLink::take(std::uint8_t byte, ControlHandler& handler) {
  if (received_ < sizeof frame_) frame_[received_] = byte;
  ++received_;
  if (received_ < frameSize()) return;
  handleFrame(handler);
  received_ = 0;
}

std::size_t UartLink::frameSize() const {
  if (frame_[0] == 'E') return kEncoderFrame;
  if (frame_[0] != 'S') return 1;
  if (received_ < kSetupFrame) return kSetupFrame;
  const UsbSetup request = setup();
  const bool from_device = request.request_type & 0x80;
  return kSetupFrame + (from_device ? 0 : request.length);
}

void UartLink::handleFrame(ControlHandler& handler) {
  switch (frame_[0]) {
    case 'S':
      return answer(handler);
    case 'R':
      return handler.handleBusReset();
    case 'E':
      return encoders_.moveTo(
          {static_cast<std::int32_t>(integer(frame_ + 1, 4)), static_cast<std::int32_t>(integer(frame_ + 5, 4))},
          static_cast<std::uint16_t>(integer(frame_ + 9, 2)));
    case 'Q':
      semihosting::exit(0);
  }
}

void UartLink::answer(ControlHandler& handler) {
  std::uint8_t frame[3 + ControlHandler::kMaxData] = {'C'};
  const bool fits = received_ <= sizeof frame_;
  const int result = fits ? handler.handleControl(setup(), frame_ + kSetupFrame, frame + 3) : ControlEndpoint::kStall;
  frame[1] = static_cast<std::uint8_t>(result);
  frame[2] = static_cast<std::uint8_t>(result >> 8);
  const std::size_t size = 3 + (result > 0 ? static_cast<std::size_t>(result) : 0);
  while (!queue_.put(frame, size)) transmit();  // an answer is never dropped
}

UsbSetup UartLink::setup() const {
  UsbSetup setup;
  setup.request_type = frame_[1];
  setup.request = frame_[2];
  setup.value = static_cast<std::uint16_t>(integer(frame_ + 3, 2));
  setup.index = static_cast<std::uint16_t>(integer(frame_ + 5, 2));
  setup.length = static_cast<std::uint16_t>(integer(frame_ + 7, 2));
  return setup;
}

}  // namespace vibe_firmware::mps2
