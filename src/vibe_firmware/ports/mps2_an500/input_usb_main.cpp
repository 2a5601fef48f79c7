#include "startup.hpp"
#include "tick_timer.hpp"
#include "uart_link.hpp"
#include "usb_board.hpp"
#include "vibe_firmware/hal/application.hpp"
#include "vibe_firmware/protocol/input_function.hpp"

// The input device with its USB traffic on UART 1; see UartLink.

namespace {

vibe_firmware::mps2::SimulatedEncoders encoders;
vibe_firmware::mps2::UsbBoard board(encoders);
vibe_firmware::mps2::UartLink link(encoders);
vibe_firmware::InputFunction device(vibe_firmware::InputConfig{}, "QEMU");
vibe_firmware::Application application(board, link, device);

}  // namespace

extern "C" void tick() {
  application.tick();
}

extern "C" void run() {
  vibe_firmware::mps2::startTicks();
  // No WFI: QEMU 7.2 with -icount sleep=off then loses every second tick.
  for (;;) application.poll();
}
