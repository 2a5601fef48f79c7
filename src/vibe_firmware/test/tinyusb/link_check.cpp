// Runs the link to TinyUSB on this machine: what TinyUSB calls must reach the handler, and a report that the handler
// refuses must stall. Registers are memory.
#include <sys/mman.h>
#include <tusb.h>
// after it
#include <device/usbd_pvt.h>

#include <cstdio>
#include <cstring>

#include "nucleo_board.hpp"
#include "tinyusb_link.hpp"

namespace {

int passed_on = 0;             // requests that TinyUSB's own driver answers
std::uint8_t* room = nullptr;  // where TinyUSB puts the data of a request
std::uint16_t room_size = 0;

/// Takes reports of four bytes.
struct Handler : vibe_firmware::ControlHandler {
  int suspended = 0, reset = 0;
  int handleControl(const vibe_firmware::UsbSetup& setup, const std::uint8_t* data, std::uint8_t*) override {
    if (setup.request != 9 || setup.request_type != 0x21) return 0;
    return setup.length == 4 && data[0] == 1 ? 0 : -1;
  }
  void handleBusReset() override { ++reset; }
  void handleSuspend() override { ++suspended; }
};

/// A SET_REPORT as TinyUSB shows it. @return false: it stalls
bool setReport(const usbd_class_driver_t& driver, std::uint8_t id, std::uint16_t length) {
  const tusb_control_request_t request = {0x21, 9, 0x0301, 0, length};
  room = nullptr;
  if (!driver.control_xfer_cb(0, CONTROL_STAGE_SETUP, &request)) return false;
  if (room == nullptr || room_size != length) return false;
  std::memset(room, id, length);
  return driver.control_xfer_cb(0, CONTROL_STAGE_DATA, &request) &&
         driver.control_xfer_cb(0, CONTROL_STAGE_ACK, &request);
}

int failures = 0;
void expect(bool good, const char* what) {
  if (!good) std::printf("wrong: %s\n", what), ++failures;
}

}  // namespace

extern "C" {
bool tusb_init(std::uint8_t, const tusb_rhport_init_t*) {
  return true;
}
void tusb_int_handler(std::uint8_t, bool) {}
void tud_task() {}
bool tud_hid_ready() {
  return true;
}
bool tud_hid_report(std::uint8_t, const void*, std::uint16_t) {
  return true;
}
bool tud_control_xfer(std::uint8_t, const tusb_control_request_t*, void* buffer, std::uint16_t length) {
  room = static_cast<std::uint8_t*>(buffer);
  room_size = length;
  return true;
}
void hidd_init() {}
bool hidd_deinit() {
  return true;
}
void hidd_reset(std::uint8_t) {}
std::uint16_t hidd_open(std::uint8_t, const tusb_desc_interface_t*, std::uint16_t) {
  return 0;
}
bool hidd_control_xfer_cb(std::uint8_t, std::uint8_t, const tusb_control_request_t*) {
  return ++passed_on > 0;
}
bool hidd_xfer_cb(std::uint8_t, std::uint8_t, xfer_result_t, std::uint32_t) {
  return true;
}
}

namespace vibe_firmware::stm32 {
void Diagnostics::write(const char*) {}
void configurePin(Gpio&, unsigned, Mode, Pull, unsigned) {}
}  // namespace vibe_firmware::stm32

int main() {
  for (const std::uintptr_t start : {0x40000000UL, 0x50000000UL, 0xE0000000UL})
    if (::mmap(reinterpret_cast<void*>(start), 0x100000, PROT_READ | PROT_WRITE,
               MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0) == MAP_FAILED)
      return std::perror("registers"), 2;
  Handler handler;
  static char memory[sizeof(vibe_firmware::stm32::Diagnostics)];
  vibe_firmware::stm32::TinyUsbLink link(reinterpret_cast<vibe_firmware::stm32::Diagnostics&>(memory));
  link.poll(handler);
  std::uint8_t count = 0;
  const usbd_class_driver_t& driver = *usbd_app_driver_get_cb(&count);
  expect(count == 1, "there is one driver");
  expect(setReport(driver, 1, 4), "a good report is taken");
  expect(!setReport(driver, 2, 4), "a report with another id stalls");
  expect(!setReport(driver, 1, 3), "a report that is too short stalls");
  expect(!setReport(driver, 1, 5), "a report that is too long stalls");
  expect(!setReport(driver, 1, 0), "an empty report stalls");
  expect(!setReport(driver, 1, 60000), "a report beyond the buffer stalls");
  expect(passed_on == 0, "TinyUSB's own driver saw no report");
  const tusb_control_request_t get = {0xA1, 1, 0x0301, 0, 4};
  expect(driver.control_xfer_cb(0, CONTROL_STAGE_SETUP, &get) && passed_on == 1, "other requests are TinyUSB's");
  tud_suspend_cb(false);
  expect(handler.suspended == 1 && handler.reset == 0, "a suspended bus is told");
  tud_umount_cb();
  expect(handler.reset == 1, "a bus that is gone is told");
  return failures == 0 ? 0 : 1;
}
