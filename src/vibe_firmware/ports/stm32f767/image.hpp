#pragma once
#include "diagnostics.hpp"
#include "nucleo_board.hpp"
#ifdef VIBE_TINYUSB
#include "tinyusb_link.hpp"
#else
#include "no_usb_link.hpp"
#endif
#include "vibe_firmware/hal/application.hpp"

// This port has never run on hardware.

namespace vibe_firmware::stm32 {

#ifdef VIBE_TINYUSB
using Link = TinyUsbLink;
#else
using Link = NoUsbLink;
#endif

/// Everything that both images share: starts the peripherals, then runs the main loop. tick() is its interrupt.
template <typename Function>
class Image {
 public:
  explicit Image(Function& function) : application_(board_, link_, function) {}

  void tick() {
    acknowledgeTick();
    application_.tick();
  }

  /// @param has_motors  wakes the bridges
  [[noreturn]] void run(bool has_motors) {
    configurePins();
    diagnostics_.write("started after: ");
    diagnostics_.write(resetReason());
    diagnostics_.write("\r\n");
    startEncoders();
    if (has_motors) wakeBridges();  // before the break input is armed: the bridge may signal a fault until it is awake
    startPwm();
    startWatchdog();
    startTiming();
    for (;;) {
      application_.poll();
      reportFault();
      diagnostics_.poll();
      asm volatile("wfi");  // until the next tick or USB event
    }
  }

 private:
  void reportFault() {
    if (fault_reported_ || !bridgeFault()) return;
    fault_reported_ = true;
    diagnostics_.write("fault of the bridge: motors off until the next reset\r\n");
  }

  bool fault_reported_ = false;
  Diagnostics diagnostics_;
  NucleoBoard board_{{}};
  Link link_{diagnostics_};
  Application<Function> application_;
};

}  // namespace vibe_firmware::stm32
